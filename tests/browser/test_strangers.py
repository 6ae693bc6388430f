"""Other sites, and texts of strangers: they can read nothing, do nothing, and are never run."""

import json
import threading
import urllib.error
import urllib.request
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit

import pytest

import synthetic_study
from chromium import DESK, Tab, started
from rovsim.dynamics.model import nominal
from rovsim.dynamics.model_file import write_model
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle

pytestmark = pytest.mark.browser
RUN = 'x<img src=x onerror="window.hacked=1">'
EVIL = RUN + r"<script>window.hacked=1</script>\text{<img/src='x'/onerror='window.hacked=1'>}"
IDS = {"schema", "verdict", "effect", "axis", "run", "vehicle", "file", "model", "axes", "unit"}
# What a page of another site may try: each must end in "nothing".
TRIES = {
    "read": "fetch(url).then(r => r.text()).catch(() => 'nothing')",
    "ask blindly": """fetch(url, {mode: 'no-cors'}).then(
        r => r.type == 'opaque' ? 'nothing' : 'read').catch(() => 'nothing')""",
    "send": "fetch(url, {method: 'POST', body: 'x'}).then(r => r.text()).catch(() => 'nothing')",
    "listen": """new Promise(done => {
        const s = new WebSocket(socket);
        s.onmessage = s.onopen = () => done('a connection');
        s.onerror = s.onclose = () => done('nothing');
    })""",
}


class Elsewhere(BaseHTTPRequestHandler):
    """A site on another port: Chromium itself keeps those of the net away from this machine."""

    def do_GET(self):
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(b"<title>elsewhere</title>")

    def log_message(self, *_):
        pass


@pytest.fixture
def elsewhere(chromium):
    """A page of another site."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), Elsewhere)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    page = chromium.new_page()
    page.goto(f"http://127.0.0.1:{server.server_port}/")
    yield page
    page.close()
    server.shutdown()
    server.server_close()


@pytest.mark.parametrize("way", TRIES)
def test_another_site_gets_nothing(elsewhere, workbench, way):
    port = urlsplit(workbench[0]).port
    for host in ("127.0.0.1", "localhost"):
        url = f"http://{host}:{port}/"
        socket = f"ws://{host}:{port}/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
        answer = elsewhere.evaluate(f"([url, socket]) => {TRIES[way]}", [url, socket])
        assert answer == "nothing"


def test_another_site_cannot_frame_the_workbench(elsewhere, workbench):
    elsewhere.set_content(f'<iframe src="{workbench[0]}/"></iframe>')
    elsewhere.wait_for_timeout(1500)
    (frame,) = elsewhere.main_frame.child_frames
    assert frame.locator("nav").count() == 0


@pytest.mark.parametrize(
    ("headers", "code"),
    [
        ({"Host": "elsewhere.example"}, 400),  # a name that points at this machine (DNS rebinding)
        ({"Origin": "http://elsewhere.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors"}, 403),
    ],
)
def test_strangers_are_turned_away(workbench, headers, code):
    request = urllib.request.Request(workbench[0], headers=headers)
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(request, timeout=10)
    assert refused.value.code == code
    refused.value.close()


def test_a_link_of_another_site_may_open_it(workbench):
    headers = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate"}
    request = urllib.request.Request(workbench[0], headers=headers)
    with urllib.request.urlopen(request, timeout=10) as answer:
        assert answer.status == 200


def poisoned(content, key=""):
    """Every text that is no id, replaced."""
    if isinstance(content, dict):
        return {k: poisoned(v, k) for k, v in content.items()}
    if isinstance(content, list):
        return [poisoned(v, key) for v in content]
    return EVIL if isinstance(content, str) and key not in IDS else content


def test_no_text_of_a_file_is_run(chromium, campaign, tmp_path):
    law = {
        "axis": "sway", "equation": "", "file": "proposed_effect.py", "error_reduction": 0.5,
        "parameters": {"sway": {"value": -4.0, "std": 0.1, "unit": EVIL}}, "effect": EVIL,
        "meaning": "", "terms": [{"on": "", "quantities": [""], "size": 1.0}],
        "rivals": [{"equation": "", "deficit": 1.0}],
    }  # fmt: skip
    content = synthetic_study.diagnosis({"steps": [{"model": EVIL, "windows_2s": 0.1}]})
    content["unexplained"] |= {"proposal": law, "disturbance": None}
    (tmp_path / "diagnosis.json").write_text(json.dumps(poisoned(content)))
    model = tmp_path / f"{RUN}.yaml"
    write_model(nominal(load_vehicle(default_vehicle())), model)
    words = [f"campaign={campaign}", f"model={model}", f"diagnosis={tmp_path / 'diagnosis.json'}"]
    process, address = started(tmp_path, *words)
    try:
        tab = Tab(chromium.new_page(viewport={"width": DESK[0], "height": DESK[1]}), address)
        tab.page.set_default_timeout(60_000)
        for screen in ("compare", "where", "why", "add", "ladder", "data", f"gallery/{RUN}"):
            tab.go(screen)
            tab.page.wait_for_timeout(1000)
            for canvas in tab.page.locator("canvas").all()[:2]:
                canvas.hover(force=True)  # names stand in tooltips
            tab.page.wait_for_timeout(300)
            assert tab.page.evaluate("window.hacked") is None, screen
            if screen == "why":
                tab.page.get_by_role("heading", name="A law for what is left").wait_for()
                assert "onerror" in tab.page.locator("body").inner_text()  # it is shown as text
        tab.page.close()
    finally:
        process.terminate()
        process.wait(20)
