"""In a browser a page has sliders and charts that keys move, fits screens of any width, and prints no errors."""

import base64
import hashlib
import json
import re
import shutil
import subprocess
from html import unescape

import pytest

from dembound.report.page import write_report

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "chrome"))), None)

WIDTHS = (1440, 390)

TRIAL = """
<script>
addEventListener("load", () => setTimeout(() => {
  const found = { width: innerWidth, inside: document.documentElement.clientWidth };
  found.needed = document.documentElement.scrollWidth;
  found.live = document.querySelectorAll("figure.is-live").length;
  found.figures = document.querySelectorAll("figure").length;
  const chart = document.querySelector("#chart-0"), svg = chart.querySelector("svg");
  const numbers = () => [...svg.querySelectorAll("text[text-anchor=middle]")].map((text) => text.textContent);
  found.all = numbers();
  svg.dispatchEvent(new KeyboardEvent("keydown", { key: "+" }));
  found.zoomed = numbers();
  svg.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
  found.moved = numbers();
  svg.dispatchEvent(new KeyboardEvent("keydown", { key: "0" }));
  found.reset = numbers();
  const controls = [...document.querySelectorAll("button, input, svg")];
  found.unnamed = controls.filter((each) => !each.getAttribute("aria-label")).length;
  found.still = getComputedStyle(document.querySelector("#chart-0 .still")).display;
  parent.postMessage(JSON.stringify(found), "*");
}, 1500));
</script>
"""

FRAMES = """<!doctype html><meta charset="utf-8"><pre id="found"></pre>
<script>
addEventListener("message", (event) => { document.querySelector("#found").textContent += event.data + "\\n"; });
</script>
"""


@pytest.fixture(scope="module")
def opened(pushed_runs, tmp_path_factory) -> tuple[dict[int, dict], str]:
    """Findings of a page about itself at each width, and the output of the browser."""
    if BROWSER is None:
        pytest.skip("no chromium or chrome is on the path")
    folder = tmp_path_factory.mktemp("browser")
    write_report(pushed_runs, folder / "page.html")
    text = (folder / "page.html").read_text(encoding="utf-8")
    script = TRIAL.removeprefix("\n<script>").removesuffix("</script>\n")
    allowed = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    text = text.replace("script-src ", f"script-src 'sha256-{allowed}' ").replace("</body>", f"{TRIAL}</body>")
    (folder / "page.html").write_text(text, encoding="utf-8")
    views = [f'<iframe src="page.html" style="width:{width}px; height:900px; border:0"></iframe>' for width in WIDTHS]
    (folder / "frames.html").write_text(FRAMES + "\n".join(views), encoding="utf-8")
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr"]
    profile = f"--user-data-dir={folder / 'profile'}"
    patience = ["--virtual-time-budget=10000", "--dump-dom", (folder / "frames.html").as_uri()]
    ended = subprocess.run(
        [BROWSER, *options, profile, *patience], capture_output=True, text=True, timeout=120, check=True
    )
    (output,) = re.findall(r'<pre id="found">(.*?)</pre>', ended.stdout, flags=re.DOTALL)
    found = [json.loads(line) for line in unescape(output).splitlines()]
    return {each["width"]: each for each in found}, ended.stderr


def test_every_figure_becomes_live_and_fits_the_screen_and_every_control_has_a_name(opened):
    assert sorted(opened[0]) == sorted(WIDTHS)
    assert "CONSOLE" not in opened[1]
    for width, found in opened[0].items():
        assert found["needed"] <= found["inside"] <= width
        assert found["live"] == found["figures"] == 8
        assert found["unnamed"] == 0
        assert found["still"] == "none"


def test_keys_zoom_charts(opened):
    found = opened[0][1440]
    whole, zoomed, moved = (
        [float(number) for number in found[name] if number[0].isdigit()] for name in ("all", "zoomed", "moved")
    )
    assert found["reset"] == found["all"]
    assert whole[0] < zoomed[0] < zoomed[-1] < whole[-1]
    assert zoomed[0] < moved[0]
