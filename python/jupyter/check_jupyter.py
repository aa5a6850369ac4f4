#!/usr/bin/env python3
"""Shows a volume in a real JupyterLab, and in the notebook that it exports, by a Chromium without a window, and looks whether
the volume was drawn.

    check_jupyter.py OUT [--chromium /usr/bin/chromium]

Run with .deps/jupyter/bin/python and PYTHONPATH=build/python; `make jupyter` does. In OUT it leaves the notebook, its export
and the screenshots. The view may ask no address for anything, and JupyterLab none but its own: all else is refused, and
fails the check.
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import secrets
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import nbformat
from playwright.sync_api import BrowserContext, Frame, Page, Request, Route, sync_playwright

PROJECT = pathlib.Path(__file__).resolve().parents[2]
ARGUMENTS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SIZE = 900, 560  # pixels of the cell
LONGEST_S = 180
SOURCE = f"""import vantage as vt
scene = vt.Scene.from_mesh("plaza.obj")
square = [[-12, -9, 0], [8, -11, 0], [11, 0, 0], [4, 10, 0], [-13, 8, 0]]
result = vt.compute(scene, vt.Target(vertices=square, name="market square"), max_range=70,
                    navigation=vt.Navigation(altitude=(3, 50)))
print(result.volume_m3)
result.view(size={SIZE}, proof=True)"""

# The canvas as numbers: how many pixels are not of the colour of its corner.
DRAWN = """() => {
  const view = document.getElementById("canvas"), copy = document.createElement("canvas");
  copy.width = view.width; copy.height = view.height;
  const context = copy.getContext("2d");
  context.drawImage(view, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  let other = 0;
  for (let i = 0; i < data.length; i += 4) {
    if ([0, 1, 2].some((k) => Math.abs(data[i + k] - data[k]) > 8)) ++other;
  }
  window.vantageSeen = window.vantageSeen ?? [];
  window.vantageSeen.push(data);
  return other / (copy.width * copy.height);
}"""
# The share of pixels by which the last two such looks differ.
CHANGED = """() => {
  const [a, b] = window.vantageSeen.slice(-2);
  let other = 0;
  for (let i = 0; i < a.length; i += 4) if ([0, 1, 2].some((k) => Math.abs(a[i + k] - b[i + k]) > 8)) ++other;
  return 4 * other / a.length;
}"""
STARTED = time.perf_counter()


def expect(condition: bool, what: str) -> None:
    if not condition:
        raise SystemExit(f"check failed: {what}")
    print(f"{time.perf_counter() - STARTED:6.1f} s  {what}", flush=True)


def waited(what: str, ask: Callable[[], Any], page: Page | None = None) -> Any:
    """What `ask` returns, once that is something. `page`: its requests are judged meanwhile."""
    end = time.monotonic() + LONGEST_S
    while time.monotonic() < end:
        found = ask()
        if found:
            return found
        if page is not None:
            page.wait_for_timeout(500)
        else:
            time.sleep(0.5)
    raise SystemExit(f"check failed: {what}: nothing after {LONGEST_S} s")


class Server:
    """JupyterLab as it comes, with settings of its own."""

    def __init__(self, out: pathlib.Path):
        self.token = secrets.token_hex(16)
        home = out / "settings"
        folders = {f"JUPYTER_{kind}_DIR": str(home / kind.lower()) for kind in ("CONFIG", "DATA", "RUNTIME")}
        self.log = open(out / "server.log", "w", encoding="utf-8")
        self.process = subprocess.Popen(
            [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1", "--ServerApp.port=0",
             f"--ServerApp.root_dir={out}", f"--IdentityProvider.token={self.token}", "--LabApp.news_url="],
            env={**os.environ, **folders}, cwd=out, stdout=self.log, stderr=self.log, start_new_session=True)
        told = waited("the server starts", lambda: sorted((home / "runtime").glob("jpserver-*.json")))[0]
        self.url = waited("the server tells its address", lambda: self._url(told))

    @staticmethod
    def _url(told: pathlib.Path) -> str:
        try:
            return str(json.loads(told.read_text(encoding="utf-8"))["url"])
        except ValueError:  # half written
            return ""

    def stop(self) -> None:
        os.killpg(self.process.pid, signal.SIGTERM)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
        self.log.close()


def guarded(context: BrowserContext, own: str) -> list[str]:
    """The addresses that were asked besides `own`; of an export only by the view, since the export has links of its own."""
    asked: list[str] = []

    def judge(route: Route, request: Request) -> None:
        if request.url.startswith((own, "file:", "blob:", "data:")):
            route.continue_()
            return
        if own != "file:" or request.frame.parent_frame is not None:
            asked.append(request.url)
        route.abort()

    context.route("**/*", judge)
    return asked


def view_in(page: Page) -> Frame:
    """The frame of the view, when it has drawn the volume."""
    place = page.locator("iframe[title='vantage: market square']")
    place.wait_for(timeout=1000 * LONGEST_S)
    place.scroll_into_view_if_needed()
    box = place.bounding_box()
    expect(box is not None and abs(box["width"] - SIZE[0]) <= 2 and abs(box["height"] - SIZE[1]) <= 2,
           f"the cell has {SIZE[0]} x {SIZE[1]} pixels")
    handle = place.element_handle()
    frame = handle.content_frame() if handle is not None else None
    if frame is None:
        raise SystemExit("check failed: the cell has no frame")
    waited("the view has a volume", lambda: frame.evaluate("() => Boolean(window.vantage?.volume)"), page)
    waited("the view has a verdict", lambda: frame.evaluate(
        "() => document.getElementById('verdict')?.textContent === 'Proved'"), page)
    return frame


def check_drawn(frame: Frame, expected_m3: float, where: str) -> None:
    volume_m3 = frame.evaluate("() => window.vantage.volume.info.volume_m3")
    expect(abs(volume_m3 - expected_m3) <= 1e-9 * expected_m3, f"{where}: the volume is that of the kernel, {volume_m3:,.1f} m3")
    drawn = waited("something is drawn", lambda: frame.evaluate(DRAWN), frame.page)
    expect(drawn > 0.2, f"{where}: {100 * drawn:.0f} % of the canvas are not background")
    frame.evaluate("() => { window.vantage.volumeView.setVisible(false); window.vantage.stage.draw(); }")
    frame.evaluate(DRAWN)
    changed = frame.evaluate(CHANGED)
    frame.evaluate("() => { window.vantage.volumeView.setVisible(true); window.vantage.stage.draw(); }")
    frame.page.wait_for_timeout(1000)  # the picture is put together
    expect(changed > 0.1, f"{where}: without the volume {100 * changed:.0f} % of the canvas are others")
    reached = frame.evaluate("() => { try { return Boolean(window.parent.document); } catch { return false; } }")
    expect(not reached, f"{where}: the view cannot reach the notebook")


def in_lab(context: BrowserContext, server: Server, notebook: pathlib.Path) -> float:
    """Runs the cell; the notebook is saved with what it shows. Returns the volume that the kernel printed."""
    asked = guarded(context, server.url)
    context.route_web_socket("**/*", lambda socket: socket.connect_to_server())
    page = context.new_page()
    page.goto(f"{server.url}lab/tree/{notebook.name}?token={server.token}")
    cell = page.locator(".jp-Notebook .jp-CodeCell .cm-content").first
    cell.wait_for(timeout=1000 * LONGEST_S)
    page.locator(".jp-Notebook-ExecutionIndicator[data-status='idle']").first.wait_for(timeout=1000 * LONGEST_S)
    expect(True, f"JupyterLab has opened {notebook.name}")
    cell.click()
    page.keyboard.press("Shift+Enter")
    frame = view_in(page)
    printed = float(page.locator(".jp-OutputArea-output pre").first.inner_text())
    check_drawn(frame, printed, "JupyterLab")
    page.screenshot(path=str(notebook.parent / "lab.png"))
    page.keyboard.press("Control+s")
    waited("the notebook is saved", lambda: "srcdoc" in notebook.read_text(encoding="utf-8"), page)
    expect(not asked, f"JupyterLab and the view ask nobody else{': ' + asked[0] if asked else ''}")
    return printed


def in_export(context: BrowserContext, notebook: pathlib.Path, expected_m3: float) -> None:
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "html", "--log-level", "ERROR", str(notebook)], check=True)
    exported = notebook.with_suffix(".html")
    asked = guarded(context, "file:")
    page = context.new_page()
    page.goto(exported.as_uri(), wait_until="domcontentloaded")
    check_drawn(view_in(page), expected_m3, "export")
    page.screenshot(path=str(notebook.parent / "export.png"))
    expect(not asked, f"the view in the export asks nobody{': ' + asked[0] if asked else ''}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--chromium", default=os.environ.get("CHROMIUM", "/usr/bin/chromium"))
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    shutil.copy(PROJECT / "examples/plaza/plaza.obj", out)
    notebook = out / "view.ipynb"
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(SOURCE)], metadata={
        "kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}), notebook)
    server = Server(out)
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=arguments.chromium, args=ARGUMENTS)
            size: Any = {"width": 1400, "height": 900}
            printed = in_lab(browser.new_context(viewport=size), server, notebook)
            expect(True, f"the notebook has {notebook.stat().st_size:,} bytes")
            in_export(browser.new_context(viewport=size), notebook, printed)
            browser.close()
    finally:
        server.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
