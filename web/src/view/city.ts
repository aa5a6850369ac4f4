// The scene's triangles.
import * as THREE from "three";
import type { Point, SceneInfo, ViewMesh } from "../engine/messages";
import { flatPlace } from "../model/flat_place";
import { heightsBelow } from "../model/heights_below";
import type { Plane } from "../model/polygon";

export interface Hit {
  /** scene frame */
  point: Point;
  plane: Plane;
  object: string;
  kind: string;
  /** index of the triangle */
  face: number;
}

const EDGES_UP_TO = 120000; // triangles: beyond, lines take longer to find than the picture is worth
const GAP = 1e-4; // of the scene's size: what rises so much above a surface stands on it

/** Of what hides the target from the probe: none of the volume's colours, and not the target's. */
export const LIT_COLOUR = 0x7b1fa2;
const LIT_UP_TO = 500000; // triangles: they take 50 ms
const LIT = new THREE.MeshBasicMaterial({
  color: LIT_COLOUR, transparent: true, opacity: 0.6, side: THREE.DoubleSide, depthWrite: false,
});

/** Lines from the lower left to the upper right of the screen, which move with nothing. */
export function hatched(colour: number): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    uniforms: { colour: { value: new THREE.Color(colour) } }, side: THREE.DoubleSide,
    vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
    fragmentShader: `uniform vec3 colour;
      void main() {
        if (mod(gl_FragCoord.x - gl_FragCoord.y, 9.0) > 2.5) discard;
        gl_FragColor = vec4(colour, 1.0);
        #include <colorspace_fragment>
      }`,
  });
}

/** Of blockers that hold the place of what is not built as it stands. */
const STAND_IN = hatched(0x20262e);

/** The triangles of what the file or the map calls ground, or else surface: as ground_of() of the library has it. */
function groundOf({ objects }: SceneInfo, triangles: ArrayLike<number>, labels: Uint32Array): number[] {
  const wanted = objects.some(({ kind }) => kind === "ground") ? "ground" : "surface";
  const isGround = objects.map(({ kind }) => kind === wanted);
  const ground: number[] = [];
  for (let i = 0; i < triangles.length; ++i) if (isGround[labels[Math.floor(i / 3)]!]) ground.push(triangles[i]!);
  return ground;
}

/** What is NaN is taken from the others. */
function orElse(values: number[], others: () => number[]): number[] {
  if (!values.some(Number.isNaN)) return values;
  const instead = others();
  return values.map((value, i) => (Number.isNaN(value) ? instead[i]! : value));
}

export class City {
  private mesh: THREE.Mesh<THREE.BufferGeometry, THREE.Material> | null = null;
  private edges: THREE.LineSegments<THREE.BufferGeometry, THREE.Material> | null = null;
  private readonly standIns = new THREE.Mesh(new THREE.BufferGeometry(), STAND_IN);
  private readonly lit = new THREE.Mesh(new THREE.BufferGeometry(), LIT);
  private litNames = "";
  private labels = new Uint32Array();
  private info: SceneInfo | null = null;
  /** triangles of the ground; null: they were not asked for yet */
  private ground: number[] | null = null;

  constructor(private readonly parent: THREE.Object3D) {
    this.lit.frustumCulled = false;
    this.lit.renderOrder = 1;
    parent.add(this.lit, this.standIns);
  }

  show(info: SceneInfo, view: ViewMesh): void {
    this.clear();
    this.info = info;
    this.ground = null;
    this.labels = view.labels as Uint32Array<ArrayBuffer>;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(view.positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(view.triangles, 1));
    const material = new THREE.MeshLambertMaterial({
      color: 0xe9e6df, side: THREE.DoubleSide, flatShading: true,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    this.mesh = new THREE.Mesh(geometry, material);
    this.parent.add(this.mesh);
    this.hatch(info, view);
    if (info.triangles > EDGES_UP_TO) return;
    const lines = new THREE.EdgesGeometry(geometry, 20);
    this.edges = new THREE.LineSegments(lines, new THREE.LineBasicMaterial({
      color: 0x3a4250, transparent: true, opacity: 0.45,
    }));
    this.parent.add(this.edges);
  }

  private hatch({ objects }: SceneInfo, { triangles, labels }: ViewMesh): void {
    const isStandIn = objects.map(({ kind }) => kind === "stand-in");
    this.standIns.geometry.dispose();
    this.standIns.geometry = new THREE.BufferGeometry();
    if (!isStandIn.includes(true) || !this.mesh) return;
    this.standIns.geometry.setAttribute("position", this.mesh.geometry.getAttribute("position"));
    this.standIns.geometry.setIndex(new THREE.BufferAttribute(triangles.filter((_, i) => isStandIn[labels[Math.floor(i / 3)]!]), 1));
  }

  /** Corners of the triangles that are drawn hatched. */
  get hatchedCorners(): number {
    return this.standIns.geometry.getIndex()?.count ?? 0;
  }

  /** Colours the objects of these names, but for the ground, and where there are others. */
  light(names: string[]): void {
    const { mesh, info, labels } = this;
    if (names.join("\n") === this.litNames || !mesh || !info) return;
    this.litNames = names.join("\n");
    const wanted = new Set(names);
    const isLit = info.objects.map(({ name, kind }) => kind !== "ground" && wanted.has(name) && info.objects.length > 1);
    const corners = mesh.geometry.getIndex()!.array;
    const all = mesh.geometry.getAttribute("position").array;
    const of = labels.reduce((count, label) => count + (isLit[label] ? 1 : 0), 0);
    const positions = new Float32Array(of > LIT_UP_TO ? 0 : 9 * of);
    let at = 0;
    for (let i = 0; i < corners.length && at < positions.length; ++i) {
      if (!isLit[labels[Math.floor(i / 3)]!]) continue;
      for (let axis = 0; axis < 3; ++axis) positions[at++] = all[3 * corners[i]! + axis]!;
    }
    this.lit.geometry.dispose();
    this.lit.geometry = new THREE.BufferGeometry();
    this.lit.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  }

  /** Something is coloured by light(). */
  isLit(): boolean {
    return this.lit.geometry.getAttribute("position")?.count > 0;
  }

  private clear(): void {
    this.light([]);
    for (const old of [this.mesh, this.edges]) {
      if (!old) continue;
      this.parent.remove(old);
      old.geometry.dispose();
      old.material.dispose();
    }
    this.mesh = this.edges = null;
  }

  hit(ray: THREE.Raycaster): Hit | null {
    if (!this.mesh || !this.info) return null;
    const [found] = ray.intersectObject(this.mesh, false);
    if (!found?.face) return null;
    const normal = found.face.normal.clone();
    if (normal.dot(ray.ray.direction) > 0) normal.negate(); // meshes face either way
    const point = this.toScene(found.point);
    const object = this.info.objects[this.labels[found.faceIndex!] ?? -1];
    return {
      point, plane: { origin: point, normal: [normal.x, normal.y, normal.z] },
      object: object?.name ?? "", kind: object?.kind ?? "", face: found.faceIndex!,
    };
  }

  /** A polygon of the surface there, at most so far from its middle; empty where there is no room for one. */
  flatPlace({ point, plane, face }: Hit, reach: number): Point[] {
    const { mesh, info } = this;
    if (!mesh || !info) return [];
    const size = Math.hypot(...info.max.map((high, i) => high - info.min[i]!));
    const triangles = { positions: mesh.geometry.getAttribute("position").array, triangles: mesh.geometry.getIndex()!.array };
    const corners = flatPlace(triangles, face, this.toView(point).toArray(), plane.normal, reach, GAP * size);
    return corners.map((corner) => this.toScene(new THREE.Vector3(...corner)));
  }

  /** z of the highest surface below each place, else of the ground above it, scene frame; NaN: there is neither. */
  surfaceBelow(places: Point[]): number[] {
    const all = this.mesh?.geometry.getIndex()!.array ?? [];
    return orElse(this.heights(all, places), () => this.groundLevels(places));
  }

  /** z of the highest ground below a place, else of that above it, scene frame; null: there is none. */
  groundBelow(place: Point): number | null {
    const z = this.groundLevels([place])[0]!;
    return Number.isNaN(z) ? null : z;
  }

  /** A place may lie under the ground, as where a plan is wrong. */
  private groundLevels(places: Point[]): number[] {
    const { mesh, info, labels } = this;
    if (!mesh || !info) return places.map(() => NaN);
    this.ground ??= groundOf(info, mesh.geometry.getIndex()!.array, labels);
    const { ground } = this;
    return orElse(this.heights(ground, places), () => this.heights(ground, places.map(([x, y]) => [x, y, Infinity])));
  }

  private heights(triangles: ArrayLike<number>, places: Point[]): number[] {
    const { mesh, info } = this;
    if (!mesh || !info) return places.map(() => NaN);
    const { array: positions } = mesh.geometry.getAttribute("position");
    const below = heightsBelow({ positions, triangles }, places.map((place) => this.toView(place).toArray()));
    return Array.from(below, (z) => z + info.origin[2]);
  }

  toScene(p: THREE.Vector3): Point {
    const o = this.info?.origin ?? [0, 0, 0];
    return [p.x + o[0], p.y + o[1], p.z + o[2]];
  }

  toView(p: Point): THREE.Vector3 {
    const o = this.info?.origin ?? [0, 0, 0];
    return new THREE.Vector3(p[0] - o[0], p[1] - o[1], p[2] - o[2]);
  }
}
