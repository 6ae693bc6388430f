"""The workbench: the four questions in a browser, on this machine only.

NiceGUI serves it: one Python process, a websocket that carries single changes (a slider redraws in
well under 200 ms; Streamlit would run the page again), FastAPI and uvicorn, which MLflow brings
anyway, and ECharts, Vue and fonts in its own package, so that nothing is fetched from elsewhere.

    app           the page: header, navigation, progress of long work
    session       what each browser tab looks at: its campaign, and work
    workbench     the open campaign and its models; knows nothing of a browser
    kept_replays  replays and errors of models, each computed once
    draft         a model being put together from effects
    work          long work in a process of its own; jobs begins it, tasks does it
    charts, parts ECharts options and HTML that several screens share
    compare …     one screen a file: TITLE, QUESTION, show(bench, place)
"""

HOST = "127.0.0.1"  # loopback: nobody else can reach it
