// A flight in the scene: its line, orange where a target is seen, its points, and the vehicle with its lines of sight.
import * as THREE from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Point } from "../engine/messages";
import { stretch, type Flight, type Moment } from "../model/flight";
import type { City } from "./city";
import { RED } from "./target";

export const FLIGHT_COLOUR = 0x2b3a67;
export const SEEN_COLOUR = 0xe07b00;
const SIGHT_COLOUR = 0x00a06a;
const DOTS_UP_TO = 500; // points: more of them are parts of circles, or a track

const dots = (color: number, size: number) => new THREE.Points(
  new THREE.BufferGeometry(), new THREE.PointsMaterial({ color, size, sizeAttenuation: false, depthTest: false, transparent: true }),
);
/** Seen through walls, where it is paler. */
const thick = (color: number, linewidth: number, opacity: number, isInFront: boolean) => new LineSegments2(
  new LineSegmentsGeometry(), new LineMaterial({ color, linewidth, opacity, transparent: true, depthTest: !isInFront, depthWrite: false }),
);
const thin = (color: number, opacity: number) => new THREE.LineSegments(
  new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color, depthTest: false, transparent: true, opacity }),
);

const sides = (line: Point[]) => line.slice(1).flatMap((to, i) => [line[i]!, to]);

export class FlightView {
  private readonly group = new THREE.Group();
  private readonly behind = { path: thick(FLIGHT_COLOUR, 2, 0.3, true), seen: thick(SEEN_COLOUR, 3, 0.35, true) };
  private readonly path = thick(FLIGHT_COLOUR, 2.5, 1, false);
  private readonly seen = thick(SEEN_COLOUR, 4.5, 1, false);
  private readonly targets = thin(RED, 0.8);
  private readonly points = dots(FLIGHT_COLOUR, 6);
  private readonly home = dots(0x111111, 11);
  private readonly climb = thin(0x111111, 0.6);
  private readonly sight = thin(SIGHT_COLOUR, 0.9);
  private readonly vehicle = dots(SIGHT_COLOUR, 14);

  constructor(parent: THREE.Object3D, private readonly city: City) {
    const all = [this.behind.path, this.behind.seen, this.path, this.seen, this.targets, this.climb, this.points, this.home, this.sight, this.vehicle];
    all.forEach((object, i) => {
      object.renderOrder = 10 + i;
      object.frustumCulled = false;
      this.group.add(object);
    });
    this.group.visible = false;
    parent.add(this.group);
  }

  show(flight: Flight): void {
    const path = sides(flight.points.map(({ at }) => at));
    const seen = flight.targets.flatMap(({ seen_m }) => seen_m.flatMap((span) => sides(stretch(flight, span))));
    for (const line of [this.path, this.behind.path]) this.setLine(line, path);
    for (const line of [this.seen, this.behind.seen]) this.setLine(line, seen);
    this.set(this.targets, flight.targets.flatMap(({ parts }) => parts.flatMap((part) => sides([...part, part[0]!]))));
    this.set(this.points, flight.points.length > DOTS_UP_TO ? [] : flight.points.map(({ at }) => at));
    this.set(this.home, flight.home ? [flight.home] : []);
    // Up to where it begins, if that is above the home; most plans begin there.
    const [first] = flight.points;
    const [x, y] = flight.home ?? [NaN, NaN];
    const isAbove = first !== undefined && Math.hypot(first.at[0] - x, first.at[1] - y) < 1;
    this.set(this.climb, flight.home && isAbove ? [flight.home, first.at] : []);
    this.group.visible = true;
  }

  /** The vehicle, and what it sees whole there. */
  fly(flight: Flight, { at, seen }: Moment): void {
    this.set(this.vehicle, [at]);
    this.vehicle.material.color.set(seen.length > 0 ? SIGHT_COLOUR : FLIGHT_COLOUR);
    this.set(this.sight, seen.flatMap((i) => flight.targets[i]!.parts.flat().flatMap((corner) => [at, corner])));
  }

  hide(): void {
    this.group.visible = false;
  }

  get isShown(): boolean {
    return this.group.visible;
  }

  /** Ends of the lines of sight, for tests. */
  get sightCount(): number {
    return this.sight.geometry.getAttribute("position")?.count ?? 0;
  }

  private set(object: THREE.Points | THREE.LineSegments, points: Point[]): void {
    object.geometry.dispose();
    object.geometry = new THREE.BufferGeometry().setFromPoints(points.map((point) => this.city.toView(point)));
    object.visible = points.length > 0;
  }

  private setLine(line: LineSegments2, points: Point[]): void {
    line.geometry.dispose();
    line.geometry = new LineSegmentsGeometry();
    line.visible = points.length > 0;
    if (points.length > 0) line.geometry.setPositions(points.flatMap((point) => this.city.toView(point).toArray()));
  }
}
