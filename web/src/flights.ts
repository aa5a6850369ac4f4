// The flight that is shown: where it comes from, where on it the vehicle is, and that it follows the mission.
import type { App } from "./app";
import { errorText } from "./engine/client";
import type { ServedFlight } from "./engine/messages";
import { boundsOf, flightFrom, momentAt, type Flight, type Moment } from "./model/flight";
import { missionText } from "./model/mission";
import { metres } from "./model/quantity";
import { showMessage } from "./ui/page";
import { FlightView } from "./view/flight";
import { TargetVolumesView } from "./view/target_volumes";

const PROFILE_PLACES = 400;
const PLAY_S = 30; // a flight that takes longer is played faster
const FARTHEST = 3; // sizes of the scene: what lies farther away is of another place

/** The flight's height along the axis, and what lies below it; NaN: nothing. Scene frame, metres. */
export interface Profile {
  x: number[];
  z: number[];
  surface: number[];
}

export const servedFlight = ({ check, name, home, notes }: ServedFlight): Flight => flightFrom(check, name, home, notes);

export class Flights {
  flight: Flight | null = null;
  profile: Profile | null = null;
  /** where the vehicle is on the axis */
  x = 0;
  moment: Moment | null = null;
  /** z of the ground below the vehicle; null: none is known there */
  ground: number | null = null;
  /** what is shown was judged by another mission than the one that is shown, and why; "": by this one */
  old = "";
  /** the program judges it; the mission that it did so by, "" where the page has not that one; null: it is of a file */
  private judgedOf: string | null = null;
  private asked = 0;
  private playing: { from: number; since: number } | null = null;
  /** the volumes of the targets are wanted */
  hasVolumes = false;
  private readonly view: FlightView;
  private readonly volumesView: TargetVolumesView;
  private readonly listeners: ((isOther: boolean) => void)[] = [];

  constructor(private readonly app: App) {
    this.view = new FlightView(app.stage.scene, app.city);
    this.volumesView = new TargetVolumesView(app.stage.scene);
  }

  /** `isOther`: not the vehicle alone has changed. */
  onChange(listener: (isOther: boolean) => void): void {
    this.listeners.push(listener);
  }

  private tell(isOther: boolean): void {
    for (const listener of this.listeners) listener(isOther);
    this.app.stage.request();
  }

  /** A file that `vantage check -o` wrote. What was shown stays where this one cannot be. */
  openCheck(text: string, name: string): void {
    let told: unknown;
    try {
      told = JSON.parse(text);
    } catch (error) {
      throw new Error(`${name} is cut short or damaged (${(error as Error).message}): write it again with vantage check`);
    }
    const flight = flightFrom(told, name);
    this.requireNear(flight);
    this.judgedOf = null;
    this.hideVolumes();
    this.put(flight, 0);
    this.old = "";
    this.tell(true);
  }

  /**
   * The one that the program was started with, judged by the mission that was opened. Where that has no volume, the page
   * shows no other mission, and the program has the volumes of its targets.
   */
  openServed(flight: Flight): void {
    this.put(flight, 0);
    this.judgedOf = this.app.volume ? missionText(this.app.mission) : "";
    this.old = "";
    this.tell(true);
    if (this.hasGivenVolumes) void this.setVolumes(true);
  }

  private requireNear(flight: Flight): void {
    const { scene } = this.app;
    if (!scene) throw new Error("open the scene of this flight first");
    const { min, max } = boundsOf(flight);
    const size = Math.max(...scene.max.map((high, i) => high - scene.min[i]!));
    const away = Math.hypot(...[0, 1].map((i) => Math.max(0, min[i]! - scene.max[i]!, scene.min[i]! - max[i]!)));
    if (away <= FARTHEST * size) return;
    throw new Error(`${flight.name}: this flight is ${metres(Math.round(away))} away from the scene that is open: open the scene that it was checked in`);
  }

  private put(flight: Flight, x: number): void {
    this.playing = null;
    this.flight = flight;
    this.view.show(flight);
    this.profile = this.profileOf(flight);
    this.setVehicle(x);
  }

  /** Another scene is shown, or it is no longer wanted. */
  close(): void {
    if (!this.flight) return;
    this.flight = this.profile = this.moment = this.ground = this.judgedOf = this.playing = null;
    ++this.asked;
    this.hideVolumes();
    this.view.hide();
    this.tell(true);
  }

  /** The program has more to say of it than a file. */
  get isServed(): boolean {
    return this.judgedOf !== null;
  }

  /** Some of its targets are volumes that it flies through. */
  private get hasGivenVolumes(): boolean {
    return this.flight?.targets.some(({ isVolume }) => isVolume) ?? false;
  }

  /** The program can compute volumes of its targets that the page does not show as that of the mission. */
  get canHaveVolumes(): boolean {
    return this.isServed && ((this.flight?.targets.length ?? 0) > 1 || this.hasGivenVolumes);
  }

  private hideVolumes(): void {
    this.hasVolumes = false;
    this.volumesView.hide();
  }

  /** The volumes of its targets, by the mission that is shown. */
  async setVolumes(areWanted: boolean): Promise<void> {
    if (!areWanted) {
      this.hideVolumes();
      return this.tell(true);
    }
    this.hasVolumes = true;
    await this.showVolumes();
  }

  private async showVolumes(): Promise<void> {
    const { app, asked } = this;
    if (this.old !== "") return; // they come once it is judged again
    const { volume } = app;
    try {
      const { volumes, mesh } = await app.late(app.engine.volumes());
      if (asked !== this.asked || !this.hasVolumes || app.engine.last !== volume) return;
      this.volumesView.show(mesh);
      const empty = volumes.filter(({ reason }) => reason !== "");
      if (empty.length > 0) showMessage(empty.map(({ name, reason }) => `${name} has no volume: ${reason}`).join("; "), true);
    } catch (error) {
      if (asked !== this.asked) return;
      this.hideVolumes();
      showMessage(errorText(error), true);
    }
    this.tell(true);
  }

  flyTo(x: number): void {
    this.playing = null;
    this.setVehicle(x);
    this.tell(false);
  }

  private setVehicle(x: number): void {
    const { flight } = this;
    if (!flight) return;
    this.x = Math.min(Math.max(x, 0), flight.end);
    this.moment = momentAt(flight, this.x);
    this.ground = this.app.city.groundBelow(this.moment.at);
    this.view.fly(flight, this.moment);
  }

  get isPlaying(): boolean {
    return this.playing !== null;
  }

  /** How many times as fast as it is flown; metres per second where that is not known. */
  get rate(): number {
    const { flight } = this;
    if (!flight) return 1;
    return flight.unit === "s" ? Math.max(1, flight.end / PLAY_S) : flight.end / PLAY_S;
  }

  /** From where the vehicle is; at the end, from the beginning. */
  play(): void {
    const { flight } = this;
    if (!flight || this.playing) {
      this.playing = null;
      return this.tell(false);
    }
    const playing = { from: this.x >= flight.end ? 0 : this.x, since: performance.now() };
    this.playing = playing;
    const step = (now: number) => {
      if (this.playing !== playing) return;
      this.setVehicle(playing.from + (Math.max(0, now - playing.since) / 1000) * this.rate);
      if (this.x >= flight.end) this.playing = null;
      else requestAnimationFrame(step);
      this.tell(false);
    };
    requestAnimationFrame(step);
    this.tell(false);
  }

  /** The volume that is shown is that of the mission: the program judges the flight by that mission, too. */
  async follow(): Promise<void> {
    const { app, flight } = this;
    if (!flight || this.judgedOf === null) return;
    const asked = ++this.asked;
    if (app.isDraft) return this.setOld("the mission is being changed");
    const text = missionText(app.mission);
    if (text === this.judgedOf) return this.setCurrent();
    if (!app.engine.isIdle) return this.setOld("the mission is being changed"); // it is told of the next volume, too
    const { volume } = app;
    this.setOld("it is judged again");
    try {
      const served = await app.late(app.engine.flight());
      if (asked !== this.asked || app.engine.last !== volume) return;
      const { x, playing } = this;
      this.put(servedFlight(served), x);
      this.playing = playing;
      this.judgedOf = text;
      if (!this.canHaveVolumes) this.hideVolumes();
      this.setOld("");
      if (this.hasVolumes) void this.showVolumes();
    } catch (error) {
      if (asked === this.asked) this.setOld(errorText(error));
    }
    this.tell(true);
  }

  private setCurrent(): void {
    this.setOld("");
    if (this.hasVolumes && !this.volumesView.isShown) void this.showVolumes();
  }

  /** The mission that is shown has no target. It is no other one than that which was opened, if none had a volume since. */
  withoutTarget(): void {
    if (this.judgedOf === "") this.setCurrent();
    else this.setOld("the mission has no target");
  }

  /** It is not judged by the mission that is shown. `why`: "" where it is. */
  setOld(why: string): void {
    if (this.old === why || this.judgedOf === null) return;
    this.old = why;
    if (why !== "") this.volumesView.hide(); // they are of the mission as it was
    this.tell(true);
  }

  private profileOf(flight: Flight): Profile {
    const between = Array.from({ length: PROFILE_PLACES + 1 }, (_, i) => (flight.end * i) / PROFILE_PLACES);
    // With the points themselves, unless they are parts of a long track.
    const own = flight.points.length > PROFILE_PLACES ? [] : flight.points.flatMap(({ arrival, departure }) => [arrival, departure]);
    const x = [...new Set([...between, ...own])].sort((a, b) => a - b);
    const places = x.map((at) => momentAt(flight, at).at);
    return { x, z: places.map(([, , z]) => z), surface: this.app.city.surfaceBelow(places) };
  }
}
