// Meshes and missions in, volumes, pictures, missions and links out.
import { Superseded, type App, type SceneSource } from "../app";
import { errorText } from "../engine/client";
import { EngineFailure } from "../engine/transport";
import { servedFlight } from "../flights";
import type { Hello, ViewMesh } from "../engine/messages";
import { isFlight } from "../model/flight";
import { divided, missionText, sceneText } from "../model/mission";
import { bytesOf, LARGEST_MISSION, read, written, type Link } from "../model/link";
import { button, element, input, showMessage } from "./page";
import { picture } from "./picture";

const LARGEST = 600e6; // bytes: no browser has the memory for more
const EXAMPLE = "plaza.obj";

type Bytes = Record<string, ArrayBuffer>;

const nameOf = (path: unknown) => String(path ?? "").split(/[\\/]/).pop() ?? "";
const isMission = (file: File) => /\.ya?ml$/i.test(file.name);
const FILES = ["mesh", "osm", "raster", "tiles", "terrain"]; // keys of the section `scene` that name one

/** What a mission file says of the scene. */
function sectionOf({ name, section }: SceneSource): Record<string, unknown> {
  const isNamed = ["mesh", "osm", "raster", "tiles"].some((key) => section[key]);
  return isNamed ? section : { mesh: name, ...section };
}

/** Whether two sections say the same, where files may lie in other folders. */
function isSame(one: Record<string, unknown>, other: Record<string, unknown>): boolean {
  const [a, b] = [one, other].map((section) => Object.entries(section)
    .map(([key, value]) => JSON.stringify([key, FILES.includes(key) ? nameOf(value) : value])).sort().join());
  return a === b;
}

/** Plans of ground stations that name no zones, as .kml does. */
const PLAN = /\.(plan|waypoints|gpx|kmz|csv)$/i;

const isMesh = (name: string) => /\.(obj|ply|stl|glb|gltf|json|cityjson)(\.gz)?$/i.test(name);

export class Files {
  /** of a link whose scene is still to be opened */
  private awaited: Link | null = null;
  /** Files are taken one after the other: a mission is computed in the scene that came with it. */
  private last: Promise<void> = Promise.resolve();
  private pending = 0;

  constructor(private readonly app: App, private readonly example: { mesh: string; mission: string }) {
    const file = input("file");
    button("open").onclick = () => file.click();
    file.onchange = () => {
      this.take([...(file.files ?? [])]);
      file.value = "";
    };
    button("example").onclick = () => this.afterwards(() => this.openExample());
    button("save").onclick = () => void this.save();
    button("link").onclick = () => void this.copyLink();
    this.acceptDrops();
    // A link that is pasted where the page is open already loads no page.
    window.addEventListener("hashchange", () => this.afterwards(async () => void (await this.openLink())));
  }

  private afterwards(work: () => Promise<void>): Promise<void> {
    this.count(1);
    this.last = this.last.then(work).catch((error: unknown) => showMessage(errorText(error), true)).finally(() => this.count(-1));
    return this.last;
  }

  /** While something is opened the page is busy, for screen readers and for tests. */
  private count(change: 1 | -1): void {
    this.pending += change;
    document.body.ariaBusy = String(this.pending > 0);
  }

  /** What the program has, or the link that the address holds, or the example. */
  start(served: { hello: Hello; mesh: ViewMesh } | null): Promise<void> {
    return this.afterwards(async () => {
      if (served) return this.openServed(served.hello, served.mesh);
      if (!(await this.openLink())) await this.openExample();
    });
  }

  private async openExample(): Promise<void> {
    const { section, body } = this.exampleMission();
    await this.app.openScene(await this.exampleSource(section));
    await this.app.openMission(body);
    this.app.lookAtTarget();
    showMessage("From everywhere in the coloured volume all of the red polygon is visible. Drag a corner of it, or draw one of your own");
  }

  private exampleMission(): { section: Record<string, unknown>; body: string } {
    const { scene, body } = divided(this.example.mission);
    return { section: scene, body };
  }

  private async exampleSource(section: Record<string, unknown>): Promise<SceneSource> {
    return { name: EXAMPLE, bytes: await new Blob([this.example.mesh]).arrayBuffer(), section, beside: {}, isExample: true };
  }

  /** What the program was started with. */
  private async openServed(hello: Hello, mesh: ViewMesh): Promise<void> {
    const { app } = this;
    const { scene, body } = divided(hello.mission);
    const name = nameOf(scene["mesh"] ?? scene["osm"] ?? scene["raster"] ?? scene["tiles"]);
    const isAlone = body.trim() === ""; // a tileset without a mission
    app.source = { name, bytes: new ArrayBuffer(0), section: scene, beside: {} };
    app.showScene(hello.scene, mesh);
    const flight = hello.flight && servedFlight(hello.flight);
    const isFlownThrough = flight?.targets.some(({ isVolume }) => isVolume) ?? false; // then the mission has no volume
    try {
      if (hello.volume) app.openMissionWith(body, await app.engine.shown(hello.volume));
      else if (isFlownThrough) await app.openUncomputed(body);
      else if (!isAlone) await app.openMission(body);
    } finally {
      if (flight) app.flights.openServed(flight);
    }
    document.title = `${isAlone ? name : hello.name} · vantage`;
    if (isAlone) return showMessage("Draw a target, or pick a surface");
    if (app.failure !== "") return app.lookAtTarget();
    // Of a tour no position need see all targets: that is no news.
    if (flight) showMessage("Play, or the slider below, flies it");
    app.lookAtTarget();
  }

  private acceptDrops(): void {
    const note = element("drop");
    window.addEventListener("dragover", (event) => {
      event.preventDefault();
      note.hidden = false;
    });
    window.addEventListener("dragleave", (event) => (note.hidden = event.relatedTarget === null ? true : note.hidden));
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      note.hidden = true;
      this.take([...(event.dataTransfer?.files ?? [])]);
    });
  }

  /** A scene, a mission, or both, with the files that the mission names. */
  take(files: File[]): void {
    this.afterwards(async () => {
      const large = files.find((file) => file.size > LARGEST);
      if (large) {
        throw new Error(`${large.name} has ${Math.round(large.size / 1e6)} MB, and this page reads no more than 600 MB: use the program`);
      }
      const missions = files.filter(isMission);
      if (missions.length > 1) throw new Error("open one mission at a time");
      const [file] = missions;
      if (file && file.size > LARGEST_MISSION) throw new Error(`${file.name} is too long: a mission has 1 MiB at most`);
      const mission = file ? divided(await file.text()) : null;
      const { flight, others } = await this.withoutFlight(files.filter((file) => !isMission(file)));
      if (mission || others.length > 0) await this.open(mission, others);
      if (flight) this.app.flights.openCheck(await flight.text(), flight.name);
    });
  }

  /** Of what is opened: the flight, and what else there is. */
  private async withoutFlight(files: File[]): Promise<{ flight: File | null; others: File[] }> {
    const are = await Promise.all(files.map(async (file) => /\.json$/i.test(file.name) && isFlight(await file.slice(0, 1000).text())));
    const flights = files.filter((_, i) => are[i]);
    if (flights.length > 1) throw new Error("open one flight at a time");
    const plan = files.find(({ name }) => PLAN.test(name));
    if (plan && files.length === 1) {
      throw new Error(`${plan.name}: this page judges no plans: run \`vantage view mission.yaml --flight ${plan.name}\`, or drop what \`vantage check -o check.json\` writes`);
    }
    return { flight: flights[0] ?? null, others: files.filter((_, i) => !are[i]) };
  }

  private async open(mission: { scene: Record<string, unknown>; body: string } | null, others: File[]): Promise<void> {
    const { app } = this;
    if (document.body.classList.contains("served")) {
      if (!mission || others.length > 0) throw new Error("this page shows one scene: start `vantage view` with another mission");
      if (!this.isOpen(mission.scene)) throw new Error("this mission is for another scene: start `vantage view` with it");
      return this.openMission(mission.body);
    }
    if (mission?.scene["osm"] || mission?.scene["raster"]) {
      throw new Error("this page reads no maps and no terrain: run `vantage view` with this mission, which shows the same page");
    }
    const wanted = nameOf(mission?.scene["mesh"]);
    const mesh = others.find((file) => file.name === wanted) ?? (wanted ? undefined : others.find((file) => isMesh(file.name)));
    if (mesh) {
      showMessage(`Reading ${mesh.name}…`);
      const section = mission?.scene ?? this.sectionFor(mesh.name);
      const source = { name: mesh.name, bytes: await mesh.arrayBuffer(), section, beside: await contentsOf(others, mesh) };
      return mission ? this.openBoth(source, mission.body) : this.openAlone(source);
    }
    if (!mission) {
      throw new Error(`${others.map((file) => file.name).join(", ")}: not a mesh that this page reads (OBJ, PLY, STL, GLB, CityJSON)`);
    }
    if (!app.scene || (wanted !== "" && wanted !== app.source.name)) {
      throw new Error(`this mission is for ${wanted || "another scene"}: open it together with that file`);
    }
    if (others.length === 0 && this.isOpen(mission.scene)) return this.openMission(mission.body);
    const section = Object.keys(mission.scene).length > 0 ? mission.scene : app.source.section;
    await this.openBoth({ ...app.source, section, beside: { ...app.source.beside, ...(await contentsOf(others)) } }, mission.body);
  }

  /** A scene and a mission in it, of files or of a link. Where the mission fails, what was open is opened again. */
  private async openBoth(source: SceneSource, body: string, link?: Link): Promise<void> {
    const { app } = this;
    const hash = link?.isExample ? link.hash : undefined; // else it has the scene with it
    const before = app.scene && app.source;
    await app.openScene(source);
    try {
      if (hash !== undefined && hash !== app.scene?.hash) throw new Error("this link was made with another version of the example");
      await this.openMission(body, !link);
    } catch (error) {
      if (before && !(error instanceof Superseded)) {
        await app.openScene(before, false);
        await app.compute();
        app.lookAtTarget();
      }
      throw error;
    }
  }

  /** A scene, and in it the mission of the link that waits for it, or that of when it was open before. */
  private async openAlone(source: SceneSource): Promise<void> {
    const { app, awaited } = this;
    await app.openScene(source);
    const isAwaited = awaited?.scene === source.name;
    if (isAwaited && (awaited.hash ?? app.scene?.hash) === app.scene?.hash) return this.openMission(awaited.mission, false);
    await app.compute();
    app.lookAtTarget();
    if (isAwaited) throw new Error(`this is another ${source.name} than that of the link, whose mission still waits for it`);
    if (app.failure !== "") return;
    showMessage(app.mission.target ? "This is the mission that was here before" : "Draw a target on the ground, a roof or a wall");
  }

  /** Of the section `scene` of a mission; missions without one are for any scene. */
  private isOpen(section: Record<string, unknown>): boolean {
    const { source } = this.app;
    return Object.keys(section).length === 0 || isSame(sectionOf({ ...source, section }), sectionOf(source));
  }

  /** `isOfFile`: its lines are those of a file. */
  private async openMission(body: string, isOfFile = true): Promise<void> {
    try {
      await this.app.openMission(body);
    } catch (error) {
      throw error instanceof EngineFailure ? new Error(errorText(error, isOfFile)) : error;
    }
    this.awaited = null;
    this.app.lookAtTarget();
    if (this.app.volume?.info.outcome === "computed") showMessage("");
  }

  private sectionFor(name: string): Record<string, unknown> {
    if (this.awaited?.scene === name) return this.awaited.section;
    // The page has no table of coordinate systems: a city that says where it lies is taken as it is.
    if (/\.(json|cityjson)(\.gz)?$/i.test(name)) return { crs: "none" };
    const up = input("up").value;
    return up === "file" ? {} : { up };
  }

  private async save(): Promise<void> {
    const format = input("format").value;
    try {
      if (format === "picture") return download("volume.png", await picture(this.app));
      if (format === "mission") return download("mission.yaml", new Blob([this.missionFile()], { type: "text/yaml" }));
      download(`volume.${format}`, new Blob([(await this.app.saved(format)).slice()]));
    } catch (error) {
      showMessage(errorText(error), true);
    }
  }

  /** What the program reads beside the scene's file. */
  missionFile(): string {
    return `${sceneText(sectionOf(this.app.source))}${missionText(this.app.mission).replace(/^\n+/, "")}`;
  }

  private async copyLink(): Promise<void> {
    try {
      const { text, needed } = await this.link();
      const needs = needed.length === 0 ? "" : `; who opens it needs ${needed.join(", ")}, too`;
      const isCopied = await copied(`${location.href.split("#")[0]}#${text}`);
      if (!isCopied) history.replaceState(null, "", `#${text}`);
      showMessage(`The link is ${isCopied ? "copied" : "in the address line"}${needs}`);
    } catch (error) {
      showMessage(errorText(error), true);
    }
  }

  /** What follows the # of a link, and the files that it has not. */
  private async link(): Promise<{ text: string; needed: string[] }> {
    const { source, scene, mission } = this.app;
    const { name, section, isExample = false } = source;
    const beside = Object.keys(source.beside);
    const isAlone = beside.length === 0 && !isExample && source.bytes.byteLength > 0; // links hold one file at most
    const link = { scene: name, section, isExample, hash: scene!.hash, mission: missionText(mission) };
    const { text, isWhole } = await written(link, isAlone ? source.bytes : null);
    return { text, needed: isWhole ? beside : [name, ...beside] };
  }

  /** True where the address holds a link. */
  private async openLink(): Promise<boolean> {
    if (location.hash.length < 2) return false;
    const { app } = this;
    try {
      const link = await read(location.hash.slice(1));
      const source = await this.sourceOf(link);
      if (source) await this.openBoth(source, link.mission, link);
      else await this.waitFor(link);
    } catch (error) {
      const isEmpty = !app.scene || (app.source.isExample && !app.mission.target);
      if (isEmpty) await this.openExample();
      showMessage(`${errorText(error)}${isEmpty ? ": this is the example instead" : ""}`, true);
    }
    return true;
  }

  /** Of what a link has with it; null: its file is to be opened. Older links do not say whether it is the example. */
  private async sourceOf(link: Link): Promise<SceneSource | null> {
    const { scene: name, section, bytes } = link;
    if (bytes !== undefined) return { name, bytes: bytesOf(bytes), section, beside: {} };
    const isExample = link.isExample ?? (link.hash === undefined && name === EXAMPLE);
    return isExample ? this.exampleSource(section) : null;
  }

  private async waitFor(link: Link): Promise<void> {
    const { app } = this;
    const isOpen = app.scene?.hash === link.hash && this.isOpen({ mesh: link.scene, ...link.section });
    if (app.scene && isOpen) return this.openMission(link.mission, false);
    this.awaited = link;
    if (!app.scene) await this.openExample();
    showMessage(`This link is for ${link.scene}: open that file, and the mission of the link follows`, true);
  }
}

/** False where the browser does not allow it. */
async function copied(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

async function contentsOf(files: File[], but?: File): Promise<Bytes> {
  const bytes: Bytes = {};
  for (const file of files) if (file !== but) bytes[file.name] = await file.arrayBuffer();
  return bytes;
}

function download(name: string, blob: Blob): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
