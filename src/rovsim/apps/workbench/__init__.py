"""The workbench: the four questions in a browser, on this machine only.

NiceGUI serves it: one Python process, a websocket that carries single changes (a slider redraws in
well under 200 ms; Streamlit would run the page again), FastAPI and uvicorn, which MLflow brings
anyway, and ECharts, Vue and fonts in its own package, so that nothing is fetched from elsewhere.

app            the page: header, navigation, progress of long work
gate           only pages of the workbench itself talk to it
session        what each browser tab looks at: its campaign, and work
place          what a screen shows stands in its address
choices        what is chosen on a screen, and the controls that change it
workbench      the open campaign and its models; knows nothing of a browser
kept_replays   replays and errors of models, each computed once
runaway        replays that run away
draft          a model being put together from effects
work           long work in a process of its own
jobs           begins it on the open campaign
tasks          does it
folders        folders to choose from
charts         options of ECharts
parts          pieces of HTML that several screens share
traces         measured and simulated over time
path           the path in three dimensions
condition_map  how much of each error varies with each condition
on_your_data   an effect over its condition
compare        a screen, as those that follow: TITLE, QUESTION, show(bench, place)
where          where the model fails
why            which effects are missing
add            effects added by hand
add_effects    a card for each of them
saving         the draft as a file
ladder         the error falling
models         two models side by side
flight         the next recording
data           what was recorded
gallery        what every effect looks like
campaigns      another campaign
new_campaign   recordings that nobody has described
"""

HOST = "127.0.0.1"  # loopback: nobody else can reach it
