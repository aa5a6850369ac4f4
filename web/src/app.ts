// What the page is about: a scene, a mission in it, and its volume, which follows.
import { placeOf, toldBy, type Engine, type Volume } from "./engine/client";
import type { Point, PointAnswer, SceneInfo, Section, ViewMesh } from "./engine/messages";
import { History } from "./model/history";
import { emptyMission, missionFrom, missionText, sceneText, type Mission } from "./model/mission";
import { faultOf } from "./model/polygon";
import { hasBadNews, metres, say } from "./ui/page";
import { seenFrom } from "./ui/results";
import { City } from "./view/city";
import { BoxesView, ProbeView, SectionView } from "./view/marks";
import { Stage } from "./view/stage";
import { TargetView } from "./view/target";
import { VolumeView } from "./view/volume";

export type Listener = () => void;

export interface Cut {
  axis: 0 | 1 | 2;
  at: number;
}

export interface SceneSource {
  name: string;
  bytes: ArrayBuffer;
  section: Record<string, unknown>;
}

export class App {
  /** False in a report. */
  canEdit = true;
  readonly city: City;
  readonly target: TargetView;
  readonly volumeView: VolumeView;
  readonly boxes: BoxesView;
  readonly sectionView: SectionView;
  readonly probeView: ProbeView;

  mission: Mission = emptyMission();
  history = new History<Mission>(this.mission);
  scene: SceneInfo | null = null;
  /** the file of the scene, and what a mission file says of it */
  source: SceneSource = { name: "", bytes: new ArrayBuffer(0), section: {} };
  volume: Volume | null = null;
  /** where the volume is a draft: its mission as it was */
  private draftOf: Mission | null = null;
  private isDragged = false;
  private isProbeOld = false;
  private isAsking = false;
  /** numbers of the missions asked for, and of the newest of which the outcome was told */
  private turn = 0;
  private told = 0;
  /** of the last mission, where it could not be computed; the last volume stays */
  failure = "";
  private failurePlace: Point | null = null;
  probe: { at: Point; inside: boolean } | null = null;
  /** a plane across an axis that the volume is cut at, scene frame; null: not */
  cut: Cut | null = null;
  section: Section | null = null;
  /** the corner that was dragged last, where a mission that cannot be computed is explained */
  dragged: number | null = null;
  /** and not what limits the view */
  private isTargetEdited = false;
  private readonly listeners: Listener[] = [];
  private isToTell = false;
  private tellProof: (text: string, volume: Volume) => void = () => {};

  constructor(readonly engine: Engine, readonly stage: Stage) {
    this.city = new City(stage.scene);
    this.volumeView = new VolumeView(stage.scene, this.city);
    this.target = new TargetView(stage.scene, this.city);
    this.boxes = new BoxesView(stage.scene, this.city);
    this.sectionView = new SectionView(stage.scene, this.city);
    this.probeView = new ProbeView(stage.scene, this.city);
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

  /** `beside`: files that the mission names, by their names. The scene that is open stays where this one cannot be read. */
  async openScene(source: SceneSource, beside: Record<string, ArrayBuffer> = {}): Promise<void> {
    const extension = /(\.[a-z0-9]+(\.gz)?)$/i.exec(source.name)?.[1]?.toLowerCase() ?? "";
    const file = `scene${extension}`;
    const text = sceneText({ ...source.section, mesh: file });
    const { info, mesh } = await this.engine.open(text, { ...beside, [file]: source.bytes }, file);
    this.source = source;
    this.showScene(info, mesh);
  }

  showScene(info: SceneInfo, mesh: ViewMesh): void {
    this.scene = info;
    this.city.show(info, mesh);
    this.stage.frameScene(info);
    this.volumeView.hide();
    this.volume = this.draftOf = null;
    this.failure = "";
    this.mission = emptyMission(info);
    this.history = new History(this.mission);
    this.dragged = null;
    this.setProbe(null);
    this.setCut(null);
    this.showMission();
    this.changed();
  }

  /** Of a mission file without its scene. The mission that is there stays where this one cannot be computed. */
  async openMission(body: string): Promise<void> {
    const volume = await this.engine.compute(body);
    if (!volume) throw new Error("something else was changed while this mission was computed: open it again");
    this.openMissionWith(body, volume);
  }

  /** `volume`: of that mission. */
  openMissionWith(body: string, volume: Volume): void {
    this.mission = missionFrom(body, volume.info, this.scene!);
    this.history.keep(this.mission);
    this.dragged = null;
    this.put(volume, null);
    this.accept(volume);
  }

  /** Shows the mission as it is, and asks for its volume: a draft of it in the middle of a drag, till it `isComplete`. */
  edit(change: (mission: Mission) => void, isComplete: boolean): void {
    const { target } = this.mission;
    change(this.mission);
    this.isTargetEdited = this.mission.target !== target;
    if (isComplete) this.history.keep(this.mission);
    this.showMission();
    this.compute(!isComplete);
  }

  /** A drag has ended. */
  keep(): void {
    this.history.keep(this.mission);
    this.compute();
  }

  step(mission: Mission | null): void {
    if (!mission) return;
    this.mission = mission;
    this.dragged = null;
    this.showMission();
    this.compute();
  }

  showMission(): void {
    const { target } = this.mission;
    if (target?.kind === "polygon") {
      this.target.show([target.vertices], { isEditable: this.canEdit, fault: this.fault(target.vertices) });
    } else {
      this.target.show(target ? (this.volume?.info.target ?? []) : [], { isEditable: false });
    }
    this.boxes.show(this.mission.keepOut, this.canEdit);
    this.stage.request();
  }

  /** Why there is no volume of these corners, and where that is said: what stands in the way, or the corner dragged. */
  private fault(vertices: Point[]): { at: Point; reason: string } | null {
    const own = faultOf(vertices);
    if (own) return { at: vertices[own.corner]!, reason: own.reason };
    const corner = this.isTargetEdited && this.dragged !== null ? vertices[Math.min(this.dragged, vertices.length - 1)]! : null;
    const at = this.failurePlace ?? corner;
    return this.failure === "" || !at ? null : { at, reason: this.failure };
  }

  get isDraft(): boolean {
    return this.draftOf !== null;
  }

  private compute(isDraft = false): void {
    const { target } = this.mission;
    if (!target) {
      this.volumeView.hide();
      this.volume = null;
      return this.changed();
    }
    this.isDragged = isDraft;
    void this.run(isDraft ? structuredClone(this.mission) : null);
  }

  /** `draftOf`: the mission, for a draft of its volume. */
  private async run(draftOf: Mission | null): Promise<void> {
    const { scene } = this;
    const { target } = this.mission;
    const turn = ++this.turn;
    const fault = target?.kind === "polygon" ? faultOf(target.vertices) : null;
    try {
      if (fault) throw new Error(`${fault.reason}; the volume is the last one`);
      const volume = await this.engine.compute(missionText(this.mission, draftOf !== null));
      if (!volume || scene !== this.scene || !this.mission.target) return; // a newer mission is on its way, or none
      this.put(volume, draftOf);
      if (this.isNews(turn)) this.accept(volume);
    } catch (error) {
      if (scene === this.scene && this.isNews(turn)) this.fail(error);
    }
    if (!this.isDragged && this.engine.isIdle) void this.completeDraft();
  }

  /** A corner that is not convex is told at once, before the answers to what was asked earlier. */
  private isNews(turn: number): boolean {
    if (turn < this.told) return false;
    this.told = turn;
    return true;
  }

  /** A drag has ended where there is no volume: the last one, which stays, is not left a draft. */
  private async completeDraft(): Promise<void> {
    const { draftOf } = this;
    if (!draftOf) return;
    const volume = await this.engine.compute(missionText(draftOf)).catch(() => null);
    if (volume && this.draftOf === draftOf) this.put(volume, null);
  }

  /** The last volume stays. */
  private fail(error: unknown): void {
    this.failure = toldBy(error);
    this.failurePlace = placeOf(error);
    say(this.failure, true);
    this.showMission();
    this.changed();
  }

  /** Shows a volume. */
  private put(volume: Volume, draftOf: Mission | null): void {
    this.volume = volume;
    this.draftOf = draftOf;
    this.volumeView.show(volume.info, volume.mesh);
    void this.askProbe();
    void this.showSection();
    this.changed();
    this.stage.request();
  }

  /** The volume that is shown is that of the mission. */
  private accept(volume: Volume): void {
    this.failure = "";
    this.showMission();
    if (volume.info.outcome !== "computed") say(`No position sees all of it: ${volume.info.reason}. ${volume.info.hint}`, true);
    else if (hasBadNews()) say("");
  }

  setProbe(at: Point | null): void {
    this.probe = at ? { at, inside: false } : null;
    if (at) void this.askProbe();
    else {
      this.probeView.hide();
      this.endEye();
    }
    this.stage.request();
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
      return say(toldBy(error), true);
    }
    if (!answer || this.probe?.at !== at || !this.volume) return;
    this.probe.inside = answer.inside;
    if (!this.isEye()) this.probeView.show(at, this.volume.info.target.flat(), answer.inside);
    const why = [
      answer.blocked_by.length > 0 ? `hidden by ${answer.blocked_by.join(", ")}` : "",
      answer.out_of_range ? "out of range" : "",
      answer.behind_target ? "behind the target" : "",
      answer.outside_of.length > 0 ? `outside of ${answer.outside_of.join(", ")}` : "",
    ].filter((text) => text !== "");
    const what = answer.inside ? `Inside: this position sees ${seenFrom(this.volume.info)}` : `Outside: ${why.join("; ") || "not all of the target is visible"}`;
    say(`${what} · z ${metres(at[2])}${this.isEye() ? " · turn and zoom to fly, Esc ends it" : ""}`);
    this.stage.request();
    this.changed();
  }

  onProof(listener: (text: string, volume: Volume) => void): void {
    this.tellProof = listener;
  }

  async proveIt(): Promise<void> {
    const { volume } = this;
    if (!volume) return;
    this.tellProof("Proving…", volume);
    let text: string;
    try {
      const { verdict } = await this.engine.prove();
      text = verdict === "proved" ? `Proved: every position of this volume sees ${seenFrom(volume.info)}.`
        : `The proof says: ${verdict.replaceAll("_", " ")}`;
    } catch (error) {
      text = toldBy(error);
    }
    if (volume === this.volume) this.tellProof(text, volume);
  }

  setCut(cut: Cut | null): void {
    this.cut = cut;
    const origin = this.scene?.origin ?? [0, 0, 0];
    this.volumeView.cutAt(cut && { axis: cut.axis, at: cut.at - origin[cut.axis] });
    void this.showSection();
    this.stage.request();
  }

  private async showSection(): Promise<void> {
    const { cut, volume } = this;
    const section = cut?.axis !== 2 || !volume ? null : await this.engine.slice(cut.at).catch(() => null);
    if (this.cut !== cut || this.volume !== volume) return;
    this.section = section;
    this.sectionView.show(section);
    this.stage.request();
    if (section) this.changed();
  }

  isEye(): boolean {
    return this.stage.hasEye();
  }

  /** The view is that of the probe, towards the target, until it is called again. It flies when the view is turned. */
  toggleEye(): void {
    if (this.isEye()) return this.endEye();
    if (!this.probe || !this.volume) return say("First probe a position", true);
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
    say("");
    if (this.probe) void this.askProbe();
    this.changed();
  }

  /** `by`: right, ahead and up as the view is turned, each a step. */
  moveProbe(by: Point): void {
    if (!this.probe) return;
    const turn = (this.stage.heading() * Math.PI) / 180;
    const step = this.stage.metresPerPixel() * 12;
    const [right, ahead, up] = by;
    const [x, y, z] = this.probe.at;
    this.setProbe([
      x + step * (right * Math.cos(turn) + ahead * Math.sin(turn)), y + step * (ahead * Math.cos(turn) - right * Math.sin(turn)),
      z + step * up,
    ]);
    if (this.isEye()) this.stage.moveEye(this.city.toView(this.probe.at));
  }

  lookAtTarget(): void {
    if (!this.volume) return;
    this.stage.lookAt(this.city.toView(this.volume.info.center), Math.min(this.volume.info.range_m, 1e4) * 3.2);
  }

  showAll(): void {
    this.endEye();
    if (this.scene) this.stage.frameScene(this.scene);
  }
}
