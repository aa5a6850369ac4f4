// Below the view: the flight's height, when each target is seen, and a slider that flies it.
import type { App } from "../app";
import type { Flight, Span } from "../model/flight";
import { ticks } from "../model/flight";
import { metres } from "../model/quantity";
import { colourOf } from "../view/target_volumes";
import { button, element, hex, input } from "./page";

const SVG = "http://www.w3.org/2000/svg";
const WIDE = 1000; // units of a chart across, whatever its width
const HIGH = 100;
const STEPS = 1000; // of the slider: one press of an arrow key
const ROWS_UP_TO = 200; // targets and links: more are not to be told apart

function svg(name: string, attributes: Record<string, string | number>): SVGElement {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  return made;
}

function chart(kind: string, label: string): SVGElement {
  return svg("svg", { class: kind, viewBox: `0 0 ${WIDE} ${HIGH}`, preserveAspectRatio: "none", role: "img", "aria-label": label });
}

function labelled(text: string, title = text): HTMLElement {
  const made = document.createElement("span");
  made.className = "row-name";
  made.textContent = text;
  made.title = title;
  return made;
}

const short = (value: number) => String(Number(value.toFixed(1)));

/** What a strip shows: where on the axis something holds. */
interface Strip {
  name: string;
  spans: Span[];
  /** what holds there: "seen whole" */
  what: string;
  /** of its rectangles */
  kind: "seen" | "linked";
  /** index of the target; null: of none */
  target: number | null;
}

function stripsOf({ targets, links }: Flight): Strip[] {
  return [
    ...targets.map(({ name, seen, isVolume }, target): Strip =>
      ({ name, spans: seen, what: isVolume ? "inside" : "seen whole", kind: "seen", target })),
    ...links.map(({ name, linked }): Strip => ({ name: `link: ${name}`, spans: linked, what: "holds", kind: "linked", target: null })),
  ];
}

/** "seen whole from 3 to 12 s, 40 to 41 s" */
function stripText({ what, spans }: Strip, unit: string): string {
  return spans.length === 0 ? `nowhere ${what}`
    : `${what} from ${spans.map(([begin, end]) => `${short(begin)} to ${short(end)}`).join(", ")} ${unit}`;
}

export class FlightPanel {
  private readonly slider = input("fly");
  private shown: Flight | null = null;

  constructor(private readonly app: App) {
    const { flights } = app;
    this.slider.oninput = () => flights.flyTo(Number(this.slider.value));
    button("play").onclick = () => flights.play();
    input("flight-volumes").onchange = () => void flights.setVolumes(input("flight-volumes").checked);
    button("close-flight").onclick = () => flights.close();
    flights.onChange((isOther) => this.show(isOther));
    this.show(true);
  }

  private show(isOther: boolean): void {
    const { flights } = this.app;
    const { flight } = flights;
    element("flight").hidden = !flight;
    if (!flight) return void (this.shown = null);
    if (isOther) {
      if (flight !== this.shown) this.drawCharts(flight);
      this.shown = flight;
      this.showVerdict(flight);
    }
    this.showVehicle(flight);
  }

  private showVerdict({ name, failures, notes, tube_m }: Flight): void {
    const { old } = this.app.flights;
    element("flight-name").textContent = name;
    const verdict = element("flight-verdict");
    const isKept = failures.length === 0;
    verdict.textContent = old !== "" ? `Not judged by this mission: ${old}` : isKept ? "keeps what is asked" : "does not keep what is asked";
    verdict.className = old !== "" || !isKept ? "bad" : "good";
    const tube = tube_m > 0 ? [`All holds within ${metres(tube_m)} of it.`] : [];
    const lines = [...(old === "" ? failures : []), ...notes, ...tube];
    const list = element<HTMLDetailsElement>("flight-more");
    list.hidden = lines.length === 0;
    element("flight-lines").replaceChildren(...lines.map((text) => {
      const item = document.createElement("li");
      item.textContent = text;
      return item;
    }));
    element("flight-rows").classList.toggle("old", old !== "");
    const { canHaveVolumes, hasVolumes } = this.app.flights;
    element("flight-volumes-label").hidden = !canHaveVolumes;
    input("flight-volumes").checked = hasVolumes;
    element("flight-rows").querySelectorAll<HTMLElement>(".row-name[data-target]").forEach((name) => {
      const swatch = document.createElement("i");
      swatch.style.background = hex(colourOf(Number(name.dataset["target"])));
      name.querySelector("i")?.remove();
      if (hasVolumes) name.prepend(swatch);
    });
  }

  private showVehicle(flight: Flight): void {
    const { flights, app } = this;
    const { moment, x, ground, isPlaying } = { ...flights, isPlaying: flights.isPlaying };
    if (!moment) return;
    if (Number(this.slider.value) !== x) this.slider.value = String(x);
    const reached = moment.seen.map((i) => flight.targets[i]!);
    const namesOf = (areVolumes: boolean) => reached.filter(({ isVolume }) => isVolume === areVolumes).map(({ name }) => name).join(", ");
    const [seen, inside] = [namesOf(false), namesOf(true)];
    const facts = [
      ...(moment.at_s === null ? [] : [`${moment.at_s.toFixed(1)} s`]), `${moment.at_m.toFixed(1)} m`,
      ground === null ? `z ${moment.at[2].toFixed(1)} m` : `${(moment.at[2] - ground).toFixed(1)} m above ground, z ${moment.at[2].toFixed(1)} m`,
    ];
    const { targets } = flight;
    const none = targets.length > 0 && targets.every(({ isVolume }) => isVolume) ? "inside no volume" : "no target in view";
    const inView = flights.old !== "" ? [] : reached.length === 0 ? [none]
      : [...(seen === "" ? [] : [`in view: ${seen}`]), ...(inside === "" ? [] : [`inside: ${inside}`])];
    const text = [...facts, ...inView].join(" · ");
    element("readout").textContent = text;
    this.slider.setAttribute("aria-valuetext", text);
    element("cursor").style.setProperty("--at", String(flight.end > 0 ? x / flight.end : 0));
    const play = button("play");
    play.textContent = isPlaying ? "Pause" : "Play";
    play.disabled = flight.end === 0;
    const rate = flights.rate >= 10 ? flights.rate.toFixed(0) : short(flights.rate);
    play.title = flight.unit === "m" ? `Fly it at ${rate} m/s: the plan does not say how fast it is flown`
      : flights.rate > 1 ? `Fly it ${rate} times as fast` : "Fly it";
    element("flight").classList.toggle("seeing", reached.length > 0);
    app.stage.request();
  }

  private get flights() {
    return this.app.flights;
  }

  private drawCharts(flight: Flight): void {
    this.slider.min = "0";
    this.slider.max = String(flight.end);
    this.slider.step = "any";
    this.slider.onkeydown = (event) => this.step(event, flight);
    const strips = stripsOf(flight);
    const rows = strips.slice(0, ROWS_UP_TO).flatMap((strip) => {
      const told = `${strip.name}: ${stripText(strip, flight.unit)}`;
      const row = chart("strip", told);
      const at = (x: number) => (flight.end > 0 ? (x / flight.end) * WIDE : 0);
      row.append(svg("rect", { class: "not-seen", x: 0, y: 0, width: WIDE, height: HIGH }));
      for (const [begin, end] of strip.spans) {
        row.append(svg("rect", { class: strip.kind, x: at(begin), y: 0, width: Math.max(1, at(end) - at(begin)), height: HIGH }));
      }
      const name = labelled(strip.name, told);
      if (strip.target !== null) name.dataset["target"] = String(strip.target);
      return [name, row];
    });
    const more = strips.length - ROWS_UP_TO;
    if (more > 0) rows.push(labelled(`and ${more} more`), chart("strip", ""));
    element("flight-rows").replaceChildren(...this.profileRow(), ...rows);
    element("axis").replaceChildren(...this.axisMarks(flight));
  }

  /** Arrows by a thousandth, Page Up and Page Down by a twentieth: with any step a browser would go by whole units. */
  private step(event: KeyboardEvent, flight: Flight): void {
    const by = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: STEPS / 20, PageDown: -STEPS / 20 }[event.key];
    if (by === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.app.flights.flyTo(this.app.flights.x + (by * flight.end) / STEPS);
  }

  private axisMarks({ end, unit }: Flight): HTMLElement[] {
    return ticks(end, 6).map((value, i, all) => {
      const mark = document.createElement("span");
      mark.textContent = i === all.length - 1 ? `${short(value)} ${unit}` : short(value);
      mark.style.left = `${end > 0 ? (100 * value) / end : 0}%`;
      return mark;
    });
  }

  private profileRow(): Element[] {
    const { profile } = this.app.flights;
    if (!profile || profile.x.length < 2) return [];
    const heights = [...profile.z, ...profile.surface.filter((z) => !Number.isNaN(z))];
    const [low, high] = [heights.reduce((a, b) => Math.min(a, b)), heights.reduce((a, b) => Math.max(a, b))];
    const end = profile.x.at(-1)!;
    const at = (x: number, z: number) => `${((x / end) * WIDE).toFixed(2)},${(HIGH - 4 - ((HIGH - 8) * (z - low)) / (high - low || 1)).toFixed(2)}`;
    const row = chart("profile", `Height: from ${metres(Math.min(...profile.z))} to ${metres(Math.max(...profile.z))}`);
    row.append(svg("path", { class: "surface", d: surfacePath(profile.x, profile.surface, at, low) }));
    row.append(svg("polyline", { class: "height", points: profile.x.map((x, i) => at(x, profile.z[i]!)).join(" ") }));
    return [labelled(`z ${short(low)} to ${short(high)} m`, "Height of the flight, and of what lies below it"), row];
  }
}

/** What lies below, filled down to the lowest height; nothing where there is nothing. */
function surfacePath(x: number[], surface: number[], at: (x: number, z: number) => string, low: number): string {
  let path = "";
  let begin = -1;
  for (let i = 0; i <= x.length; ++i) {
    const isThere = i < x.length && !Number.isNaN(surface[i]!);
    if (isThere && begin < 0) begin = i;
    if (isThere || begin < 0) continue;
    const top = x.slice(begin, i).map((value, k) => at(value, surface[begin + k]!));
    path += `M${at(x[begin]!, low)} L${top.join(" ")} L${at(x[i - 1]!, low)} Z `;
    begin = -1;
  }
  return path;
}
