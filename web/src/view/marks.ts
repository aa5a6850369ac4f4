// Small things in the scene: keep-out boxes, zones, what is not built, a slice, the point that is asked about.
import * as THREE from "three";
import type { Box, LedgerEntry, Point, Section, Zone } from "../engine/messages";
import { hatched, type City } from "./city";
import type { Pointer, Stage } from "./stage";

const BROWN = 0x8a4b14;
const BODY = new THREE.MeshBasicMaterial({ color: BROWN, transparent: true, opacity: 0.16, depthWrite: false });
const EDGES = new THREE.LineBasicMaterial({ color: BROWN });
const DOTS = new THREE.PointsMaterial({ color: BROWN, size: 9, sizeAttenuation: false, depthTest: false, transparent: true });

/** What a box is dragged by: the middle of a face, or of the box (axis -1), which moves all of it. */
export interface Handle {
  box: number;
  axis: -1 | 0 | 1 | 2;
  end: "min" | "max";
  at: THREE.Vector3;
}

export class BoxesView {
  private readonly group = new THREE.Group();
  private handles: Handle[] = [];

  constructor(parent: THREE.Object3D, private readonly city: City) {
    parent.add(this.group);
  }

  show(boxes: Box[], hasHandles: boolean): void {
    clear(this.group);
    this.handles = hasHandles ? boxes.flatMap((box, i) => this.handlesOf(box, i)) : [];
    for (const box of boxes) {
      const low = this.city.toView(box.min);
      const high = this.city.toView(box.max);
      const size = high.clone().sub(low);
      const shape = new THREE.BoxGeometry(size.x, size.y, size.z);
      const body = new THREE.Mesh(shape, BODY);
      const edges = new THREE.LineSegments(new THREE.EdgesGeometry(shape), EDGES);
      for (const object of [body, edges]) {
        object.position.copy(low).add(high).multiplyScalar(0.5);
        this.group.add(object);
      }
    }
    const dots = new THREE.Points(new THREE.BufferGeometry().setFromPoints(this.handles.map(({ at }) => at)), DOTS);
    dots.renderOrder = 7;
    this.group.add(dots);
  }

  private handlesOf(box: Box, index: number): Handle[] {
    const low = this.city.toView(box.min);
    const high = this.city.toView(box.max);
    const middle = low.clone().add(high).multiplyScalar(0.5);
    const handles: Handle[] = [{ box: index, axis: -1, end: "min", at: middle }];
    for (const axis of [0, 1, 2] as const) {
      for (const end of ["min", "max"] as const) {
        const from = end === "min" ? low : high;
        handles.push({ box: index, axis, end, at: middle.clone().setComponent(axis, from.getComponent(axis)) });
      }
    }
    return handles;
  }

  handleAt(event: Pointer, stage: Stage): Handle | null {
    return this.handles[stage.nearestAt(event, this.handles.map(({ at }) => at))] ?? null;
  }
}

type Prism = Pick<Zone, "rings" | "low" | "high">;

/** Top and bottom of a prism, and what joins them at its corners. */
function linesOf(city: City, { rings, low, high }: Prism): THREE.BufferGeometry {
  const lines = rings.flatMap((ring) => ring.flatMap(([x, y], i) => {
    const [nextX, nextY] = ring[(i + 1) % ring.length]!;
    const at = (u: number, v: number, z: number) => city.toView([u, v, z]);
    return [at(x, y, low), at(nextX, nextY, low), at(x, y, high), at(nextX, nextY, high), at(x, y, low), at(x, y, high)];
  }));
  return new THREE.BufferGeometry().setFromPoints(lines);
}

function bodyOf(city: City, { rings, low, high }: Prism, material: THREE.Material): THREE.Mesh {
  const inView = ([x, y]: [number, number]) => city.toView([x, y, low]); // about the scene's origin: single precision
  const [outer, ...holes] = rings.map((ring) => ring.map((corner) => new THREE.Vector2(inView(corner).x, inView(corner).y)));
  const shape = new THREE.Shape(outer);
  shape.holes = holes.map((hole) => new THREE.Path(hole));
  const body = new THREE.Mesh(new THREE.ExtrudeGeometry(shape, { depth: high - low, bevelEnabled: false }), material);
  body.position.z = inView([0, 0]).z;
  return body;
}

function clear(group: THREE.Group): void {
  for (const old of group.children) (old as THREE.Mesh).geometry.dispose();
  group.clear();
}

const AMBER = 0xb26b00;
const OPEN = hatched(AMBER);
const OPEN_EDGES = new THREE.LineBasicMaterial({ color: AMBER });

/** What the scene's source has and nothing in the scene holds the place of. Blockers that stand in are the city's. */
export class LedgerView {
  private readonly group = new THREE.Group();

  constructor(parent: THREE.Object3D, private readonly city: City) {
    parent.add(this.group);
  }

  show(entries: LedgerEntry[]): void {
    clear(this.group);
    for (const entry of entries.filter(({ held, rings }) => !held && rings.length > 0)) {
      this.group.add(new THREE.LineSegments(linesOf(this.city, entry), OPEN_EDGES));
      // Rings of a ledger may be parts of one that is open: each by itself.
      for (const ring of entry.rings) if (ring.length > 2 && entry.high > entry.low) this.group.add(bodyOf(this.city, { ...entry, rings: [ring] }, OPEN));
    }
  }

  get count(): number {
    return this.group.children.filter((one) => one instanceof THREE.LineSegments).length;
  }
}

const GREEN = 0x009e73;
const KEPT_IN = new THREE.LineBasicMaterial({ color: GREEN });

/** Zones of the mission, which the page has no handles for. */
export class ZonesView {
  private readonly group = new THREE.Group();

  constructor(parent: THREE.Object3D, private readonly city: City) {
    parent.add(this.group);
  }

  show(zones: Zone[]): void {
    clear(this.group);
    for (const zone of zones) {
      this.group.add(new THREE.LineSegments(linesOf(this.city, zone), zone.kept_out ? EDGES : KEPT_IN));
      if (zone.kept_out && zone.high > zone.low) this.group.add(bodyOf(this.city, zone, BODY)); // else all of it is out of reach
    }
  }

  get count(): number {
    return this.group.children.filter((one) => one instanceof THREE.LineSegments).length;
  }
}

export class SectionView {
  private readonly lines = new THREE.LineSegments(
    new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x1b2a44, depthTest: false, transparent: true }),
  );

  constructor(parent: THREE.Object3D, private readonly city: City) {
    this.lines.renderOrder = 8;
    this.lines.frustumCulled = false;
    parent.add(this.lines);
  }

  show(section: Section | null): void {
    const points: THREE.Vector3[] = [];
    for (const rings of section?.polygons ?? []) {
      for (const ring of rings) {
        ring.forEach(([x, y], i) => {
          const [nextX, nextY] = ring[(i + 1) % ring.length]!;
          points.push(this.city.toView([x, y, section!.z_m]), this.city.toView([nextX, nextY, section!.z_m]));
        });
      }
    }
    this.lines.geometry.dispose();
    this.lines.geometry = new THREE.BufferGeometry().setFromPoints(points);
  }
}

export class ProbeView {
  private readonly group = new THREE.Group();
  private readonly dot = new THREE.Points(
    new THREE.BufferGeometry(), new THREE.PointsMaterial({ size: 16, sizeAttenuation: false, depthTest: false, transparent: true }),
  );
  private readonly line = new THREE.LineSegments(
    new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ depthTest: false, transparent: true, opacity: 0.8 }),
  );

  constructor(parent: THREE.Object3D, private readonly city: City) {
    this.group.add(this.line, this.dot);
    this.group.renderOrder = 9;
    parent.add(this.group);
    this.hide();
  }

  /** `target`: its corners, to which lines of sight are drawn. */
  show(at: Point, target: Point[], isInside: boolean): void {
    const eye = this.city.toView(at);
    const colour = isInside ? 0x00a06a : 0xd32f2f;
    this.dot.material.color.set(colour);
    this.line.material.color.set(colour);
    this.dot.geometry.dispose();
    this.dot.geometry = new THREE.BufferGeometry().setFromPoints([eye]);
    this.line.geometry.dispose();
    this.line.geometry = new THREE.BufferGeometry().setFromPoints(target.flatMap((corner) => [eye, this.city.toView(corner)]));
    this.group.visible = true;
  }

  hide(): void {
    this.group.visible = false;
  }
}
