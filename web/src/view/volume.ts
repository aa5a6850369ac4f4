// The volume, coloured by what bounds it.
import * as THREE from "three";
import type { ViewMesh, VolumeInfo } from "../engine/messages";
import type { City } from "./city";
import { KIND_COLOURS } from "./stage";

function areaOf(positions: Float32Array, at: number): number {
  const side = (k: number, axis: number) => positions[at + 3 * k + axis]! - positions[at + axis]!;
  const x = side(1, 1) * side(2, 2) - side(1, 2) * side(2, 1);
  const y = side(1, 2) * side(2, 0) - side(1, 0) * side(2, 2);
  const z = side(1, 0) * side(2, 1) - side(1, 1) * side(2, 0);
  return Math.hypot(x, y, z) / 2;
}

export class VolumeView {
  private isShown = false;
  private isAllowed = true;
  private readonly geometry = new THREE.BufferGeometry();
  private readonly plane = new THREE.Plane();
  private readonly material = new THREE.MeshLambertMaterial({
    vertexColors: true, transparent: true, opacity: 0.42, side: THREE.DoubleSide, depthWrite: false, flatShading: true,
  });
  private readonly mesh = new THREE.Mesh(this.geometry, this.material);
  private labels = new Uint32Array();
  private info: VolumeInfo | null = null;
  private given: ViewMesh | null = null; // not expanded yet
  private areas = new Map<string, number>();

  constructor(parent: THREE.Object3D, private readonly city: City) {
    this.mesh.visible = false;
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
    parent.add(this.mesh);
  }

  show(info: VolumeInfo, view: ViewMesh): void {
    this.info = info;
    this.given = view;
    this.isShown = view.triangles.length > 0;
    this.setVisible(this.isAllowed);
  }

  /** To be called before a picture is drawn. There may be several volumes to a picture: only the last is worth the work. */
  update(): void {
    const { info, given } = this;
    this.given = null;
    if (!info || !given) return;
    this.labels = given.labels as Uint32Array<ArrayBuffer>;
    const { positions, colours } = this.expanded(info, given);
    this.geometry.dispose();
    this.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    this.geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    this.geometry.boundingSphere = null;
  }

  /** Square metres of the volume's surface that each kind of cause bounds. */
  areaOfKind(): Map<string, number> {
    this.update();
    return this.areas;
  }

  /** Corners of its own for each triangle, with the colour of its cause. Runs while something is dragged: no objects. */
  private expanded(info: VolumeInfo, view: ViewMesh): { positions: Float32Array; colours: Float32Array } {
    const palette = new Float32Array(3 * info.causes.length);
    info.causes.forEach(({ kind }, i) => new THREE.Color(KIND_COLOURS[kind] ?? 0x0072b2).toArray(palette, 3 * i));
    const count = view.triangles.length;
    const positions = new Float32Array(3 * count);
    const colours = new Float32Array(3 * count);
    const areas = new Float64Array(info.causes.length);
    for (let i = 0; i < count; ++i) {
      const from = 3 * view.triangles[i]!;
      const label = view.labels[(i / 3) | 0]!;
      for (let axis = 0; axis < 3; ++axis) {
        positions[3 * i + axis] = view.positions[from + axis]!;
        colours[3 * i + axis] = palette[3 * label + axis]!;
      }
      if (i % 3 === 2) areas[label]! += areaOf(positions, 3 * (i - 2));
    }
    this.areas = new Map();
    info.causes.forEach(({ kind }, i) => this.areas.set(kind, (this.areas.get(kind) ?? 0) + areas[i]!));
    return { positions, colours };
  }

  hide(): void {
    this.isShown = false;
    this.mesh.visible = false;
    this.info = this.given = null;
  }

  /** False while the eye is in it. */
  setVisible(isVisible: boolean): void {
    this.isAllowed = isVisible;
    this.mesh.visible = this.isShown && this.isAllowed;
  }

  /** Lowest and highest z, scene frame. */
  heights(): [number, number] {
    this.update();
    const positions = this.geometry.getAttribute("position").array;
    let [low, high] = [Infinity, -Infinity];
    for (let i = 2; i < positions.length; i += 3) {
      low = Math.min(low, positions[i]!);
      high = Math.max(high, positions[i]!);
    }
    const z = this.city.toScene(new THREE.Vector3())[2];
    return [low + z, high + z];
  }

  /** Nothing beyond this along the axis (view coordinates) is drawn. */
  cutAt(cut: { axis: 0 | 1 | 2; at: number } | null): void {
    this.material.clippingPlanes = cut ? [this.plane] : null;
    if (cut) this.plane.set(new THREE.Vector3().setComponent(cut.axis, -1), cut.at);
  }

  /** What bounds the volume where the ray meets it first. */
  causeAt(ray: THREE.Raycaster): { kind: string; name: string } | null {
    this.update();
    if (!this.mesh.visible || !this.info) return null;
    for (const found of ray.intersectObject(this.mesh, false)) {
      if (!this.material.clippingPlanes || this.plane.distanceToPoint(found.point) >= 0) return this.info.causes[this.labels[found.faceIndex!]!] ?? null;
    }
    return null;
  }
}
