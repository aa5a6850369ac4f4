// What the page is about: a scene, a mission in it, and its volume, which follows.
import { errorText, placeOf, type Engine, type Volume } from "./engine/client";
import { Stopped } from "./engine/transport";
import type { MissionInfo, Point, PointAnswer, Proof, SceneInfo, Section, ViewMesh } from "./engine/messages";
import { Flights } from "./flights";
import { History } from "./model/history";
import { emptyMission, missionFrom, missionText, sceneText, type Mission, type PolygonTarget } from "./model/mission";
import { faultOf } from "./model/polygon";
import { metres } from "./model/quantity";
import { emptyText, pointText, proofText } from "./model/volume";
import { clearMessage, replaceMessage, showMessage, showsError } from "./ui/page";
import { City } from "./view/city";
import { BoxesView, LedgerView, ProbeView, SectionView, ZonesView } from "./view/marks";
import { Stage } from "./view/stage";
import { TargetView } from "./view/target";
import { VolumeView } from "./view/volume";

export type Listener = () => void;

const LATE_MS = 500;
const LATE_FIRST = "Computing…";
const RESTORING = "Computing the shown volume again…";
const LATE = `${LATE_FIRST} What is shown is still the last volume`;
const WAITING = "Other windows of the program compute: waiting for a turn…";

export interface Cut {
  axis: 0 | 1 | 2;
  at: number;
}

export interface SceneSource {
  name: string;
  bytes: ArrayBuffer;
  section: Record<string, unknown>;
  /** these are the bytes of the example, which every page has */
  isExample?: boolean;
  /** files that missions name, by their names */
  beside: Record<string, ArrayBuffer>;
}

/** Of a mission that is not opened, since the one that is there was edited meanwhile. */
export class Superseded extends Error {
  constructor() {
    super("something else was changed while this mission was computed: open it again");
  }
}

export class App {
  /** False in a report. */
  canEdit = true;
  readonly city: City;
  readonly target: TargetView;
  readonly volumeView: VolumeView;
  readonly boxes: BoxesView;
  readonly zones: ZonesView;
  readonly ledger: LedgerView;
  readonly sectionView: SectionView;
  readonly probeView: ProbeView;
  readonly flights: Flights;

  mission: Mission = emptyMission();
  history = new History<Mission>(this.mission);
  scene: SceneInfo | null = null;
  /** of scenes that were open, by their hashes: they have it again when they are opened again */
  private readonly former = new Map<string, { mission: Mission; history: History<Mission> }>();
  /** the file of the scene, and what a mission file says of it */
  source: SceneSource = { name: "", bytes: new ArrayBuffer(0), section: {}, beside: {} };
  volume: Volume | null = null;
  /** the mission that the volume is of, as it was */
  private shownOf: Mission | null = null;
  /** the volume has coarser facets */
  isDraft = false;
  private isDragged = false;
  private hasRestoreFailed = false;
  private isProbeOld = false;
  private isAsking = false;
  private lateWorks = 0;
  /**
   * The order of volumes. Each wish for one has a turn, a number that grows. The engine answers in the order of the
   * questions, or says that a newer one took the place of one that waited. There are three kinds of wishes:
   * - run(): the volume of `mission`, after edit(), keep() and step(). It is shown also where `mission` was changed
   *   meanwhile, so that the volume follows a drag: the newest is on its way then.
   * - openMission(): the volume of a text, which becomes `mission` together with it, if nothing was wished for since.
   * - restore(): once more the volume that is shown.
   * What holds when nothing is awaited and nothing dragged: the volume shown is that of `mission`, exactly, or
   * `failure` says why that has none; and it is the last one of the engine, unless restore() failed or was stopped. What
   * the engine answers to query, slice, prove or save while its last volume is another one is dropped.
   */
  private turn = 0;
  /** of the newest wish of which the outcome was told */
  private told = 0;
  /** answers to earlier wishes are of another scene, or of a target that is gone */
  private since = 0;
  /** of the last mission, where it could not be computed; the last volume stays */
  failure = "";
  /** what the mission of the volume says; where there is no volume, the one that was opened */
  said: MissionInfo | null = null;
  private failurePlace: Point | null = null;
  private isStopped = false;
  probe: { at: Point; inside: boolean } | null = null;
  /** a plane across an axis that the volume is cut at, scene frame; null: not */
  cut: Cut | null = null;
  section: Section | null = null;
  /** the corner that was dragged last, where a mission that cannot be computed is explained */
  dragged: number | null = null;
  /** corners of a target that is being drawn, which is shown in the place of the mission's */
  drawn: Point[] = [];
  /** and not what limits the view */
  private isTargetEdited = false;
  private readonly listeners: Listener[] = [];
  private isToTell = false;
  private readonly proofListeners: ((text: string, volume: Volume, proof?: Proof) => void)[] = [];

  constructor(readonly engine: Engine, readonly stage: Stage) {
    engine.onWaits = () => replaceMessage(this.lateWords, LATE, LATE_FIRST, WAITING);
    this.city = new City(stage.scene);
    this.volumeView = new VolumeView(stage.scene, this.city);
    this.target = new TargetView(stage.scene, this.city);
    this.boxes = new BoxesView(stage.scene, this.city);
    this.zones = new ZonesView(stage.scene, this.city);
    this.ledger = new LedgerView(stage.scene, this.city);
    this.sectionView = new SectionView(stage.scene, this.city);
    this.probeView = new ProbeView(stage.scene, this.city);
    this.flights = new Flights(this);
    stage.beforeFrame = () => this.volumeView.update();
  }

  onChange(listener: Listener): void {
    this.listeners.push(listener);
  }

  /** What listens is told with the next picture: volumes may come more often. */
  changed(): void {
    if (this.isToTell) return;
    this.isToTell = true;
    requestAnimationFrame(() => {
      this.isToTell = false;
      for (const listener of this.listeners) listener();
    });
  }

  /**
   * The scene that is open stays where this one cannot be read. One that was open before has its mission again, which
   * is still to be computed.
   */
  async openScene(source: SceneSource, canStop = true): Promise<void> {
    const extension = /(\.[a-z0-9]+(\.gz)?)$/i.exec(source.name)?.[1]?.toLowerCase() ?? "";
    const file = `scene${extension}`;
    const text = sceneText({ ...source.section, mesh: file });
    const opened = this.engine.open(text, { ...source.beside, [file]: source.bytes }, file);
    const { info, mesh } = await (canStop ? this.late(opened) : opened);
    this.source = source;
    this.showScene(info, mesh);
  }

  showScene(info: SceneInfo, mesh: ViewMesh): void {
    this.setProbe(null); // ends the view of its eye before all of the scene is looked at
    if (this.scene) this.former.set(this.scene.hash, { mission: this.mission, history: this.history });
    const former = this.former.get(info.hash);
    if (info.hash !== this.scene?.hash) this.flights.close(); // it is of the other scene
    this.scene = info;
    this.city.show(info, mesh);
    this.ledger.show(info.ledger.worst);
    this.stage.frameScene(info);
    this.since = ++this.turn;
    this.mission = former?.mission ?? emptyMission(info);
    this.history = former?.history ?? new History(this.mission);
    this.dragged = null;
    this.drawn = [];
    this.isDragged = false;
    this.setCut(null);
    this.clearVolume();
  }

  /**
   * Of a mission file without its scene. The mission that is there stays where this one cannot be read. Where it has no
   * volume, as when its target is refused, it is shown without.
   */
  async openMission(body: string): Promise<void> {
    const turn = ++this.turn;
    try {
      const volume = await this.late(this.engine.compute(body));
      if (!volume || turn !== this.turn) throw new Superseded();
      this.openMissionWith(body, volume);
    } catch (error) {
      if (turn === this.turn && (await this.openWithout(body, error, turn))) return;
      // It may have taken the place of an edit that waited.
      if (turn === this.turn && this.told < turn - 1) {
        if (error instanceof Stopped) this.fail(error);
        else await this.compute(this.isDragged);
      }
      throw error;
    } finally {
      this.settle();
    }
  }

  /** `volume`: of that mission. */
  openMissionWith(body: string, volume: Volume): void {
    const mission = this.takeMission(body, volume.info);
    this.put(volume, structuredClone(mission), false);
    this.accept(volume);
  }

  /** A mission that no volume is asked of: all that it says is kept. */
  async openUncomputed(body: string): Promise<void> {
    const info = await this.engine.read(body);
    this.takeMission(body, info);
    this.showWithout(info);
  }

  private takeMission(body: string, info: MissionInfo): Mission {
    const mission = missionFrom(body, info, this.scene!);
    this.history.keep(this.mission);
    this.mission = mission;
    this.history.keep(mission);
    this.dragged = null;
    this.isDragged = false;
    this.told = this.turn;
    return mission;
  }

  /** `error`: why it has no volume. False: it cannot be read either, or was stopped where there is another mission. */
  private async openWithout(body: string, error: unknown, turn: number): Promise<boolean> {
    if (error instanceof Superseded || (error instanceof Stopped && this.mission.target)) return false;
    const info = await this.engine.read(body).catch(() => null);
    if (!info || turn !== this.turn) return false;
    this.takeMission(body, info);
    this.showWithout(info);
    this.fail(error);
    return true;
  }

  private showWithout(info: MissionInfo): void {
    this.clearVolume();
    this.said = info;
    this.zones.show(info.limits.zones);
    this.showMission();
  }

  /** Shows the mission as it is, and asks for its volume: a draft of it in the middle of a drag, till it `isComplete`. */
  edit(change: (mission: Mission) => void, isComplete: boolean): void {
    const { target } = this.mission;
    change(this.mission);
    this.isTargetEdited = this.mission.target !== target;
    if (isComplete) this.history.keep(this.mission);
    this.showMission();
    void this.compute(!isComplete);
  }

  /** A drag has ended. */
  keep(): void {
    if (!this.isDragged) return; // nothing was moved
    this.history.keep(this.mission);
    void this.compute();
  }

  step(mission: Mission | null): void {
    if (!mission) return;
    this.mission = mission;
    this.dragged = null;
    showMessage("");
    this.showMission();
    void this.compute();
  }

  /** The target as corners that can be dragged; null: it has none, or more than one part. */
  polygon(): PolygonTarget | null {
    const { target } = this.mission;
    if (target?.kind === "polygon") return target;
    const { volume, shownOf } = this;
    // Of a surface that was picked the volume tells the corners.
    if (!target || target.kind === "written" || !volume || JSON.stringify(target) !== JSON.stringify(shownOf?.target)) return null;
    const [vertices, ...others] = volume.info.target;
    if (!vertices || vertices.length < 3 || others.length > 0) return null;
    return { kind: "polygon", vertices, front: volume.info.normal };
  }

  showMission(): void {
    const { target } = this.mission;
    const polygon = this.polygon();
    if (this.drawn.length > 0) {
      const fault = this.drawn.length >= 3 ? this.fault(this.drawn) : null;
      this.target.show([this.drawn], { isEditable: true, isOpen: true, fault });
    } else if (polygon) {
      this.target.show([polygon.vertices], { isEditable: this.canEdit, fault: this.fault(polygon.vertices) });
    } else {
      const parts = target?.kind === "written" ? this.mission.parts : target ? (this.volume?.info.target ?? []) : [];
      const fault = this.failurePlace && this.failure !== "" ? { at: this.failurePlace, reason: this.failure } : null;
      this.target.show(parts, { isEditable: false, fault });
    }
    this.boxes.show(this.mission.keepOut, this.canEdit);
    this.stage.request();
  }

  /** Why there is no volume of these corners, and where that is said: what stands in the way, or the corner dragged. */
  private fault(vertices: Point[]): { at: Point; reason: string } | null {
    const own = faultOf(vertices);
    if (own) return { at: vertices[own.corner]!, reason: own.reason };
    if (this.failure === "" || this.isStopped || vertices === this.drawn) return null;
    const corner = this.isTargetEdited ? vertices[Math.min(this.dragged ?? 0, vertices.length - 1)]! : null;
    const at = this.failurePlace ?? corner;
    return at && { at, reason: this.failure };
  }

  /** Asks for the volume of the mission as it is. */
  async compute(isDraft = false): Promise<void> {
    ++this.turn;
    this.isDragged = isDraft;
    if (this.mission.target) return this.run(this.turn, structuredClone(this.mission), isDraft);
    this.since = this.told = this.turn;
    this.clearVolume();
    this.flights.withoutTarget();
  }

  private get lateWords(): string {
    return this.engine.waits ? WAITING : this.volume ? LATE : LATE_FIRST;
  }

  /** `mission`: the one that is edited, as it is now. */
  private async run(turn: number, mission: Mission, isDraft: boolean): Promise<void> {
    const { target } = mission;
    const fault = target?.kind === "polygon" ? faultOf(target.vertices) : null;
    const tell = () => turn === this.turn && showMessage(this.lateWords);
    try {
      if (fault) throw new Error(`${fault.reason}; the volume shown is that of the last valid target`);
      const volume = await this.late(this.engine.compute(missionText(mission, isDraft)), tell);
      if (!volume || turn < this.since) return;
      this.put(volume, mission, isDraft);
      if (this.isNews(turn)) this.accept(volume);
    } catch (error) {
      if (turn >= this.since && this.isNews(turn)) this.fail(error);
    } finally {
      if (turn === this.turn) clearMessage(LATE, LATE_FIRST, WAITING);
      this.settle();
    }
  }

  /** Work that can be stopped once it takes long, when `tell` is called. */
  async late<T>(work: Promise<T>, tell: () => void = () => {}): Promise<T> {
    let isCounted = false;
    const timer = setTimeout(() => {
      isCounted = true;
      ++this.lateWorks;
      tell();
      this.changed();
    }, LATE_MS);
    try {
      return await work;
    } finally {
      clearTimeout(timer);
      if (isCounted) {
        --this.lateWorks;
        this.changed();
      }
    }
  }

  /** Something is opened, computed or proved for so long that one may want to stop it. */
  isLate(): boolean {
    return this.lateWorks > 0;
  }

  /** The last volume stays, and the last scene. */
  stop(): void {
    if (!this.isLate()) return;
    this.engine.stop();
    setTimeout(() => this.settle()); // after those were told who asked
  }

  /** The mission has no volume, since that was stopped. */
  get wasStopped(): boolean {
    return this.failure !== "" && this.isStopped;
  }

  /** A corner that is not convex is told at once, before the answers to what was asked earlier. */
  private isNews(turn: number): boolean {
    if (turn < this.told) return false;
    this.told = turn;
    return true;
  }

  /** The last volume stays where a mission has none. It is not left a draft, and the engine must have it. */
  private settle(): void {
    const isDone = this.engine.last === this.volume && (!this.isDraft || this.isDragged);
    if (this.volume && !isDone && !this.hasRestoreFailed && this.engine.isIdle) void this.restore();
  }

  private async restore(): Promise<void> {
    const { shownOf } = this;
    if (!shownOf) return;
    // What is wrong with the mission, or that it was stopped, stays said.
    const tell = () => this.shownOf === shownOf && !showsError() && showMessage(RESTORING);
    try {
      const volume = await this.late(this.engine.compute(missionText(shownOf)), tell);
      if (volume && this.shownOf === shownOf) this.putAgain(volume, shownOf);
    } catch {
      this.hasRestoreFailed = true; // it stays as it is: a draft, or one that the engine answers nothing about
    } finally {
      clearMessage(RESTORING);
    }
  }

  /** What is drawn of it stays, and what was said of it, where it is the same again. */
  private putAgain(volume: Volume, mission: Mission): void {
    const shown = this.volume;
    const isSame = shown && !this.isDraft && shown.info.facets === volume.info.facets && shown.info.volume_m3 === volume.info.volume_m3;
    if (!isSame) return this.put(volume, mission, false);
    this.engine.last = shown;
    void this.askProbe();
    void this.showSection();
  }

  /** The last volume stays. */
  private fail(error: unknown): void {
    this.failure = errorText(error);
    this.isStopped = error instanceof Stopped;
    this.failurePlace = placeOf(error);
    showMessage(this.failure, true);
    this.flights.setOld("the mission has no volume");
    this.showMission();
    this.changed();
  }

  /** Shows a volume. `mission`: what it is of. */
  private put(volume: Volume, mission: Mission, isDraft: boolean): void {
    this.volume = volume;
    this.said = volume.info;
    this.shownOf = mission;
    this.isDraft = isDraft;
    this.hasRestoreFailed = false;
    this.volumeView.show(volume.info, volume.mesh);
    this.zones.show(volume.info.limits.zones);
    this.showOutline(null);
    void this.askProbe();
    void this.showSection();
    this.changed();
    this.stage.request();
  }

  /** Nothing of a volume is left. */
  private clearVolume(): void {
    this.endEye();
    this.volume = this.said = this.shownOf = this.failurePlace = null;
    this.isDraft = false;
    this.failure = "";
    this.volumeView.hide();
    this.zones.show([]);
    this.probeView.hide();
    this.city.light([]);
    this.showOutline(null);
    this.showMission();
    this.changed();
    showMessage("");
  }

  /** The volume that is shown is that of the mission. */
  private accept(volume: Volume): void {
    this.failure = "";
    this.showMission();
    void this.flights.follow();
    if (volume.info.outcome !== "computed") showMessage(`${emptyText(volume.info)} ${volume.info.hint}`, true);
    else if (showsError()) showMessage("");
  }

  setProbe(at: Point | null): void {
    this.probe = at ? { at, inside: false } : null;
    if (at) void this.askProbe();
    else {
      this.probeView.hide();
      this.city.light([]);
      this.endEye();
    }
    this.stage.request();
    this.changed();
  }

  /** One question at a time: the newest that waits is enough. */
  private async askProbe(): Promise<void> {
    this.isProbeOld = true;
    if (this.isAsking) return;
    this.isAsking = true;
    while (this.isProbeOld) {
      this.isProbeOld = false;
      await this.askOnce();
    }
    this.isAsking = false;
  }

  private async askOnce(): Promise<void> {
    if (!this.probe || !this.volume) return;
    const { at } = this.probe;
    let answer: PointAnswer | undefined;
    try {
      [answer] = await this.engine.query([at]);
    } catch (error) {
      if (this.isEngineHere() || this.hasRestoreFailed) showMessage(errorText(error), true);
      return;
    }
    if (!answer || this.probe?.at !== at || !this.volume || !this.isEngineHere()) return;
    this.probe.inside = answer.inside;
    this.city.light(answer.blocked_by);
    if (!this.isEye()) this.probeView.show(at, this.volume.info.target.flat(), answer.inside);
    showMessage(`${pointText(this.volume.info, answer)} · z ${metres(at[2])}${this.isEye() ? " · turn and zoom to fly; Esc, or Look, ends it" : ""}`);
    this.stage.request();
    this.changed();
  }

  onProof(listener: (text: string, volume: Volume, proof?: Proof) => void): void {
    this.proofListeners.push(listener);
  }

  private tellProof(text: string, volume: Volume, proof?: Proof): void {
    for (const listener of this.proofListeners) listener(text, volume, proof);
  }

  async proveIt(): Promise<void> {
    const { volume } = this;
    if (!volume) return;
    this.tellProof("Proving…", volume);
    let text: string;
    let proof: Proof;
    try {
      proof = await this.late(this.engine.prove());
      text = proofText(volume.info, proof);
    } catch (error) {
      if (volume === this.volume) this.tellProof(errorText(error), volume);
      return;
    }
    if (volume === this.volume && this.isEngineHere()) this.tellProof(text, volume, proof);
  }

  /** The volume as a file. */
  async saved(format: string): Promise<Uint8Array> {
    const bytes = await this.engine.save(format);
    if (!this.isEngineHere()) throw new Error("the volume was changed meanwhile: save it again");
    return bytes;
  }

  /** What the engine has just answered is of the volume that is shown. */
  private isEngineHere(): boolean {
    return this.engine.last === this.volume;
  }

  setCut(cut: Cut | null): void {
    this.cut = cut;
    const origin = this.scene?.origin ?? [0, 0, 0];
    this.volumeView.cutAt(cut && { axis: cut.axis, at: cut.at - origin[cut.axis] });
    this.showOutline(null);
    void this.showSection();
    this.stage.request();
  }

  private async showSection(): Promise<void> {
    const { cut } = this;
    if (cut?.axis !== 2 || !this.volume) return;
    const section = await this.engine.slice(cut.at).catch(() => null);
    if (this.cut === cut && this.volume && this.isEngineHere()) this.showOutline(section);
  }

  private showOutline(section: Section | null): void {
    if (section || this.section) this.changed();
    this.section = section;
    this.sectionView.show(section);
    this.stage.request();
  }

  isEye(): boolean {
    return this.stage.hasEye();
  }

  /** The view is that of the probe, towards the target, until it is called again. It flies when the view is turned. */
  toggleEye(): void {
    if (this.isEye()) return this.endEye();
    if (!this.probe || !this.volume) return showMessage("First probe a position", true);
    const camera = this.engine.about.cameras.find(({ name }) => name === this.mission.camera);
    this.stage.beginEye(this.city.toView(this.probe.at), this.city.toView(this.volume.info.center), camera?.fov_deg[1]);
    this.stage.onEye = (eye) => this.setProbe(this.city.toScene(eye));
    this.volumeView.setVisible(false);
    this.probeView.hide();
    void this.askProbe();
  }

  endEye(): void {
    if (!this.isEye()) return;
    this.stage.endEye();
    this.volumeView.setVisible(true);
    showMessage("");
    if (this.probe) void this.askProbe();
    this.changed();
  }

  /** `by`: right, ahead and up as the view is turned, each a step. False: there is no probe. */
  moveProbe(by: Point): boolean {
    if (!this.probe) return false;
    const turn = (this.stage.heading() * Math.PI) / 180;
    const step = this.stage.metresPerPixel() * 12;
    const [right, ahead, up] = by;
    const [x, y, z] = this.probe.at;
    this.setProbe([
      x + step * (right * Math.cos(turn) + ahead * Math.sin(turn)), y + step * (ahead * Math.cos(turn) - right * Math.sin(turn)),
      z + step * up,
    ]);
    if (this.isEye()) this.stage.moveEye(this.city.toView(this.probe.at));
    return true;
  }

  lookAtTarget(): void {
    const { said } = this;
    const corners = said?.target.flat() ?? [];
    if (!said || corners.length === 0) return;
    const middle = [0, 1, 2].map((axis) => corners.reduce((sum, corner) => sum + corner[axis]!, 0) / corners.length) as Point;
    this.stage.lookAt(this.city.toView(this.volume?.info.center ?? middle), Math.min(said.range_m, 1e4) * 3.2);
  }

  showAll(): void {
    this.endEye();
    if (this.scene) this.stage.frameScene(this.scene);
  }
}
