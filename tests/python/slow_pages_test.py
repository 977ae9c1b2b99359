"""Every page in a real browser: no error, no request, plots drawn, readable on a telephone.

Needs Debian's chromium; skipped, saying so, where it is absent. Pictures go to SNARE_PICTURES where that is set.
"""

import base64
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import setting

CHROMIUM = shutil.which("chromium")
if CHROMIUM is None:
    print("skipped: chromium is not installed")
    sys.exit(setting.SKIPPED)

PICTURES = os.environ.get("SNARE_PICTURES")
SMALL = ["--set", "solver.elements=32"]
# A page of every verb: its arguments, and the least number of plots.
PAGES = {
    "push": (["push", "examples/push.toml"], 4),
    "fit": (["fit", "examples/push.toml", *SMALL], 4),
    "trace": (["trace", "examples/push.toml", *SMALL], 4),
    "reproduce": (["reproduce", *SMALL], 4),
    "reproduce_paper": (["reproduce", "abiko"], 8),
    "distil": (["distil", "WIRE"], 3),
    "compare": (["compare", "examples/push.toml", *SMALL], 4),
    "compare_motions": (["compare", "data/scenarios/snare_on_pin.toml"], 0),
    "simulate": (["simulate", "data/scenarios/snare_on_pin.toml"], 2),
    "simulate_capture": (["simulate", "data/scenarios/ssrms_htv_capture.toml", "--set", 'snares[snare].wire.model="stretched"'], 2),
    "simulate_probe": (["simulate", "data/scenarios/air_table.toml", "--set", "duration_s=0.02"], 2),
    "simulate_arm": (["simulate", "data/scenarios/jemrms_step.toml"], 2),
    "ringdown": (["ringdown", "data/experiments/ringdown.toml"], 1),
}

# Put before everything else of a page: keeps what goes wrong, and at the end writes what it is like into its title.
WATCH = """<script>
window.snareProblems = [];
window.addEventListener('error', e => snareProblems.push('error: ' + (e.message || (e.target && (e.target.src || e.target.href)))), true);
window.addEventListener('unhandledrejection', e => snareProblems.push('rejected: ' + e.reason));
for (const level of ['error', 'warn']) console[level] = (...x) => snareProblems.push(level + ': ' + x.join(' '));
window.addEventListener('load', () => setTimeout(() => {
  const drawn = [...document.querySelectorAll('svg')].filter(s =>
    s.querySelector('path[d], circle, line') && s.getBoundingClientRect().width > 50);
  const slider = document.querySelector('input[type=range]');
  let acts = null;
  if (slider) {
    const before = document.body.innerHTML;
    slider.value = Math.round((+slider.min + +slider.max) / 2);
    slider.dispatchEvent(new Event('input', {bubbles: true}));
    acts = document.body.innerHTML !== before;
  }
  const wide = [...document.querySelectorAll('body *')].filter(e => {
    if (e.getBoundingClientRect().right <= innerWidth + 1) return false;
    for (let p = e.parentElement; p; p = p.parentElement)
      if (['auto', 'scroll', 'hidden'].includes(getComputedStyle(p).overflowX)) return false;
    return true;
  });
  const small = [...document.querySelectorAll('p, td, li')].filter(e => e.textContent.trim() && parseFloat(getComputedStyle(e).fontSize) < 11);
  const answer = {problems: snareProblems, plots: drawn.length, acts, width: innerWidth, scroll: document.documentElement.scrollWidth,
    requests: performance.getEntriesByType('resource').map(r => r.name).filter(n => !n.startsWith('data:') && !n.startsWith('blob:')),
    wide: wide.slice(0, 3).map(e => e.tagName + '.' + (e.className.baseVal ?? e.className) + ' ' + e.textContent.slice(0, 40)), small: small.length};
  const mark = document.createElement('template');
  mark.setAttribute('data-snare', btoa(unescape(encodeURIComponent(JSON.stringify(answer)))));
  document.body.append(mark);
}, 300));
</script>"""


def browse(page: pathlib.Path, *options: str) -> str:
    with tempfile.TemporaryDirectory() as profile:
        run = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--force-device-scale-factor=1",
                              f"--user-data-dir={profile}", "--virtual-time-budget=5000", *options, page.as_uri()],
                             capture_output=True, text=True, timeout=180)
    return run.stdout


def looked_at(page: pathlib.Path, width: int) -> dict:
    """What the page is like in a frame of this width: headless windows are never narrower than 500 px."""
    text = page.read_text()
    watched = page.with_name("watched.html")
    head = text.index("<head>") + len("<head>")
    watched.write_text(text[:head] + WATCH + text[head:])
    frame = page.with_name("frame.html")
    frame.write_text(f"""<!doctype html><body style="margin:0"><iframe src="watched.html" style="border:0;width:{width}px;height:3000px"></iframe>
<script>addEventListener('load', () => setTimeout(() => {{
  document.body.setAttribute('data-found', frames[0].document.querySelector('template[data-snare]').dataset.snare); }}, 1500));</script>""")
    dom = browse(frame, "--dump-dom", "--allow-file-access-from-files", "--window-size=1400,3000")
    if PICTURES:
        picture = pathlib.Path(PICTURES) / f"{page.parent.name}_{width}.png"
        browse(frame, f"--screenshot={picture}", "--allow-file-access-from-files", f"--window-size={max(500, width)},1600")
    found = re.search(r'data-found="([^"]+)"', dom)
    if found is None:
        raise AssertionError(f"{page}: the page did not come to its end")
    return json.loads(base64.b64decode(found.group(1)))


class Pages(unittest.TestCase):
    def test_every_page_opens_and_is_drawn(self):
        with tempfile.TemporaryDirectory() as name:
            for verb, (arguments, plots) in PAGES.items():
                with self.subTest(verb):
                    folder = pathlib.Path(name) / verb
                    arguments = [str(setting.small_wire(name)) if x == "WIRE" else x for x in arguments]
                    arguments = [str(setting.SOURCE / x) if x.endswith(".toml") and x[0] != "/" else x for x in arguments]
                    setting.run_command(*arguments, "--out", str(folder))
                    for width in (1280, 390):
                        found = looked_at(folder / "report.html", width)
                        print(f"{verb} at {width} px: {found['plots']} plots, scrolls to {found['scroll']} px", flush=True)
                        self.assertEqual(found["width"], width)
                        self.assertEqual(found["problems"], [])
                        self.assertEqual(found["requests"], [])
                        self.assertGreaterEqual(found["plots"], plots)
                        self.assertNotEqual(found["acts"], False, "a slider moves something")
                        self.assertEqual(found["wide"], [], "nothing goes beyond the page but what scrolls")
                        self.assertLessEqual(found["scroll"], width + 1)
                        self.assertEqual(found["small"], 0, "letters of less than 11 px")


if __name__ == "__main__":
    setting.main()
