import { App } from "./app";
import { Engine, errorText } from "./engine/client";
import { RecordedTransport } from "./engine/recorded_transport";
import { SocketTransport } from "./engine/socket_transport";
import type { Transport } from "./engine/transport";
import { WorkerTransport } from "./engine/worker_transport";
import { metres } from "./model/quantity";
import { Files } from "./ui/files";
import { FlightPanel } from "./ui/flight_panel";
import { button, element, showMessage } from "./ui/page";
import { Panel } from "./ui/panel";
import { makeReport } from "./ui/report";
import { Results } from "./ui/results";
import { Tools } from "./ui/tools";
import { Stage } from "./view/stage";

const TURN_DEG = 6;
const NEARER = 1.15;

declare global {
  interface Window {
    /** the engine and the example, in a page that works by itself */
    vantageData?: { worker: string; wasm: string; mesh: string; mission: string };
    /** in a page that the program serves */
    vantageLive?: { socket: string };
    /** in a report: what the program answered, by its calls */
    vantageReport?: Record<string, string>;
    /** for tests and measurements */
    vantage?: App;
  }
}

function makeStage(): Stage {
  try {
    return new Stage(element<HTMLCanvasElement>("canvas"));
  } catch {
    throw new Error("this browser draws no WebGL: switch hardware acceleration on, or try another browser");
  }
}

function setTheme(stage: Stage, isDark: boolean): void {
  document.documentElement.classList.toggle("dark", isDark);
  stage.setDark(isDark);
}

function drawScale(stage: Stage): void {
  const wanted = 90 * stage.metresPerPixel();
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map((f) => f * power).find((l) => l <= wanted) ?? power;
  element("scale").querySelector("span")!.textContent = length >= 1000 ? `${length / 1000} km` : metres(length);
  element("scale").querySelector("i")!.style.width = `${length / stage.metresPerPixel()}px`;
  element("compass").style.transform = `rotate(${-stage.heading()}deg)`;
}

/** What is wrong with the target, at the corner where it is, or at the edge of the view. */
function drawFault(app: App): void {
  const note = element("fault");
  const { faulty } = app.target;
  note.hidden = !faulty;
  // Read aloud, but not shown twice.
  element("hint").classList.toggle("beside", faulty !== null && element("hint").textContent === faulty.reason);
  if (!faulty) return;
  note.textContent = faulty.reason;
  const { clientWidth, clientHeight } = app.stage.canvas;
  const { x, y, z } = app.stage.project(faulty.at);
  const isBehind = z >= 1; // where it would be drawn says nothing then
  const [left, top] = isBehind ? [clientWidth / 2, clientHeight] : [x + 12, y + 12];
  note.style.left = `${Math.max(4, Math.min(left, clientWidth - note.offsetWidth - 4))}px`;
  note.style.top = `${Math.max(4, Math.min(top, clientHeight - note.offsetHeight - 4))}px`;
}

/** What keys do; false: nothing, here. */
function keysOf(app: App, tools: Tools): Record<string, () => void | boolean> {
  const { stage } = app;
  const view = {
    f: () => app.showAll(), "?": () => element<HTMLDialogElement>("help-text").showModal(),
    "+": () => stage.turn(0, 0, 1 / NEARER), "=": () => stage.turn(0, 0, 1 / NEARER), "-": () => stage.turn(0, 0, NEARER),
    "Shift+ArrowRight": () => stage.turn(TURN_DEG, 0), "Shift+ArrowLeft": () => stage.turn(-TURN_DEG, 0),
    "Shift+ArrowUp": () => stage.turn(0, TURN_DEG), "Shift+ArrowDown": () => stage.turn(0, -TURN_DEG),
  };
  return !app.canEdit ? view : {
    ...view,
    d: () => tools.choose("draw"), p: () => tools.choose("pick"), q: () => tools.choose("probe"),
    Escape: () => (app.isLate() ? app.stop() : tools.choose("look")),
    Enter: () => tools.finish(), Delete: () => tools.removeLast(), Backspace: () => tools.removeLast(),
    ArrowRight: () => app.moveProbe([1, 0, 0]), ArrowLeft: () => app.moveProbe([-1, 0, 0]),
    ArrowUp: () => app.moveProbe([0, 1, 0]), ArrowDown: () => app.moveProbe([0, -1, 0]),
    PageUp: () => app.moveProbe([0, 0, 1]), PageDown: () => app.moveProbe([0, 0, -1]),
  };
}

function listenToKeys(app: App, tools: Tools): void {
  const keys = keysOf(app, tools);
  document.addEventListener("keydown", (event) => {
    const typed = event.target as HTMLElement;
    if (event.altKey) return; // the browser's own
    if (typed.matches("select, textarea, input:not([type=range])") || element<HTMLDialogElement>("help-text").open) return;
    if (typed.matches("input") && /^(Arrow|Page)/.test(event.key)) return; // they move the slider
    if (event.ctrlKey || event.metaKey) {
      const key = event.key.toLowerCase();
      if (!app.canEdit) return;
      if (key === "z" && !event.shiftKey) tools.undo();
      else if (key === "y" || key === "z") tools.redo();
      else return;
    } else {
      if (typed.tagName === "BUTTON" && event.key === "Enter") return;
      const isTurn = event.shiftKey && event.key.startsWith("Arrow");
      const act = keys[isTurn ? `Shift+${event.key}` : event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!act || act() === false) return;
    }
    event.preventDefault();
  });
}

function listenToButtons(app: App): void {
  button("fit").onclick = () => app.showAll();
  button("theme").onclick = () => setTheme(app.stage, !document.documentElement.classList.contains("dark"));
  button("help").onclick = () => element<HTMLDialogElement>("help-text").showModal();
}

async function transportOfPage(): Promise<Transport> {
  const { vantageData, vantageLive, vantageReport } = window;
  if (vantageReport) return RecordedTransport.start(vantageReport);
  if (vantageLive) return SocketTransport.start(vantageLive.socket, (reason) => showMessage(reason, true));
  if (!vantageData) throw new Error("this page is a part of the program: 'vantage report' fills it");
  return WorkerTransport.start(vantageData.worker, vantageData.wasm);
}

async function start(): Promise<void> {
  const stage = makeStage();
  setTheme(stage, matchMedia("(prefers-color-scheme: dark)").matches);
  const engine = new Engine(await transportOfPage());
  const isServed = Boolean(window.vantageLive ?? window.vantageReport);
  const served = isServed ? await engine.hello() : null;
  if (!served) await engine.greet();
  const app = new App(engine, stage);
  app.canEdit = !window.vantageReport;
  new Panel(app, engine.about);
  new Results(app);
  new FlightPanel(app);
  const tools = new Tools(app);
  const files = new Files(app, window.vantageData ?? { mesh: "", mission: "" });
  element("version").textContent = `vantage ${engine.about.version}`;
  stage.onFrame = () => {
    drawScale(stage);
    drawFault(app);
  };
  listenToButtons(app);
  listenToKeys(app, tools);
  window.vantage = app;
  document.body.classList.toggle("served", isServed);
  document.body.classList.toggle("report", Boolean(window.vantageReport));
  if (served) showMessage("");
  await files.start(served);
  if (served && window.vantageReport) makeReport(app, served.hello, window.vantageReport["made"] ?? "");
}

start().catch((error: unknown) => showMessage(errorText(error), true));
