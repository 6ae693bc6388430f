"""The workbench: the four questions in a browser, on this machine only.

NiceGUI serves it: one Python process, a websocket that carries single changes (a slider redraws in
well under 200 ms; Streamlit would run the page again), FastAPI and uvicorn, which MLflow brings
anyway, and ECharts, Vue and fonts in its own package, so that nothing is fetched from elsewhere.

app            the page: header, navigation, progress of long work
gate           refuses requests that do not come from a page of the workbench
session        the campaign and the work of each browser tab
place          keeps what a screen shows in its address
choices        what was chosen on a screen, and the controls that change it
workbench      the open campaign and its models; knows nothing of a browser
kept_replays   replays and errors of models, each computed once
divergence     replays that diverge
draft          a model being put together from effects
work           long work in a process of its own
jobs           begins long work on the open campaign
tasks          the long work itself
folders        folders to choose from
chart_axes     axes of the charts (ECharts)
charts         options of the charts
parts          pieces of HTML that several screens share
traces         a chart of measured and simulated values over time
path           a chart of the path in three dimensions
condition_map  a chart of how much of each error varies with each condition
on_your_data   a chart of an effect over its condition
compare        a screen, like all that follow (TITLE, QUESTION, show(bench, place)): replays
where          a screen: where the model fails
why            a screen: which effects are missing
add            a screen: effects added by hand
add_effects    a card for each effect that is added
saving         saves the draft as a file
ladder         a screen: the error falling step by step
models         a screen: two models side by side
flight         a screen: the next recording
data           a screen: what was recorded
gallery        a screen: what every effect looks like
campaigns      a screen: open another campaign
new_campaign   a screen: recordings that nobody has described
"""

HOST = "127.0.0.1"  # loopback: nobody else can reach it
