// The view as a picture, with what one needs to read it: what the colours are, the scale, where north is.
import type { App } from "../app";
import { LIT_COLOUR } from "../view/city";
import { FLIGHT_COLOUR, SEEN_COLOUR } from "../view/flight";
import { RED } from "../view/target";
import { element, hex } from "./page";

const FONT = "13px system-ui, sans-serif";
const LINE = 19; // pixels of the page, as all lengths here
const EDGE = 12;
const INK = "#1b1f24";

interface Row {
  colour: string;
  text: string;
}

/** As the panel has them, of what can be seen. */
function legend(app: App): Row[] {
  const { failure, volume } = app;
  const rows: Row[] = [];
  if (volume && failure === "") rows.push({ colour: hex(RED), text: "the target" });
  if (app.city.isLit()) rows.push({ colour: hex(LIT_COLOUR), text: "hides some of the target from the probe" });
  if (app.flights.flight) {
    rows.push({ colour: hex(FLIGHT_COLOUR), text: `the flight ${app.flights.flight.name}` });
    rows.push({ colour: hex(SEEN_COLOUR), text: "where it sees all of a target" });
  }
  if (app.isEye()) return rows;
  return [...rows, ...[...element("legend").children].map((item) => ({
    colour: item.querySelector("i")!.style.background, text: item.textContent ?? "",
  }))];
}

/** What all of it is; where the volume is not that of the target, this. */
function titleOf(app: App): string {
  if (app.failure !== "") return element("status").textContent ?? "";
  return app.isEye() ? "The view from the probe" : element("claim").textContent ?? "";
}

/** Under the view, which it hides nothing of. */
function drawLegend(to: CanvasRenderingContext2D, title: string, rows: Row[], top: number, width: number): void {
  to.fillText(title, EDGE, top + EDGE + LINE / 2, width - 2 * EDGE);
  rows.forEach(({ colour, text }, i) => {
    const middle = top + EDGE + (i + 1.5) * LINE;
    to.fillStyle = colour;
    to.fillRect(EDGE, middle - 6, 12, 12);
    to.fillStyle = INK;
    to.fillText(text, EDGE + 20, middle, width - 2 * EDGE - 20);
  });
}

/** Whom the licence of the scene's data asks to name: in the view, to the left. */
function drawCredit(to: CanvasRenderingContext2D, credit: string, left: number, bottom: number): void {
  if (credit === "") return;
  to.save();
  to.fillStyle = "#ffffffcc";
  to.fillRect(left - 4, bottom - LINE, to.measureText(credit).width + 8, LINE);
  to.fillStyle = INK;
  to.fillText(credit, left, bottom - LINE / 2);
  to.restore();
}

function drawScale(to: CanvasRenderingContext2D, right: number, bottom: number): void {
  const length = Number.parseFloat(element("scale").querySelector("i")!.style.width);
  to.textAlign = "right";
  to.fillText(element("scale").textContent?.trim() ?? "", right, bottom - 16);
  to.textAlign = "left";
  to.beginPath();
  to.moveTo(right - length, bottom - 7);
  to.lineTo(right - length, bottom);
  to.lineTo(right, bottom);
  to.lineTo(right, bottom - 7);
  to.stroke();
}

/** `heading`: degrees clockwise from north that up is. */
function drawNorth(to: CanvasRenderingContext2D, x: number, y: number, heading: number): void {
  to.save();
  to.translate(x, y);
  to.rotate((-heading * Math.PI) / 180);
  to.beginPath();
  for (const [dx, dy] of [[0, -16], [6, 0], [-6, 0]] as const) to.lineTo(dx, dy);
  to.fill();
  to.textAlign = "center";
  to.fillText("N", 0, 10);
  to.restore();
}

export function picture(app: App): Promise<Blob> {
  const { stage } = app;
  stage.draw();
  const { canvas } = stage;
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = canvas.width / width;
  const rows = legend(app);
  const below = rows.length === 0 ? 0 : (rows.length + 1) * LINE + 2 * EDGE;
  const made = document.createElement("canvas");
  [made.width, made.height] = [canvas.width, canvas.height + Math.ceil(below * ratio)];
  const to = made.getContext("2d")!;
  to.fillStyle = "white";
  to.fillRect(0, 0, made.width, made.height);
  to.drawImage(canvas, 0, 0);
  to.scale(ratio, ratio);
  to.font = FONT;
  to.textBaseline = "middle";
  to.lineWidth = 2;
  to.fillStyle = to.strokeStyle = getComputedStyle(element("scale")).color;
  if (!app.isEye()) drawScale(to, width - EDGE, height - EDGE);
  drawNorth(to, width - 2 * EDGE, 2.5 * EDGE, stage.heading());
  drawCredit(to, app.scene?.attribution ?? "", EDGE, height - EDGE / 2);
  to.fillStyle = INK;
  if (below > 0) drawLegend(to, titleOf(app), rows, height, width);
  return new Promise((resolve, reject) => {
    made.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the picture could not be made"))));
  });
}
