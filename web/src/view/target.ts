// The target, its corners to drag, and the part that is drawn so far.
import * as THREE from "three";
import type { Point } from "../engine/messages";
import type { City } from "./city";
import type { Pointer, Stage } from "./stage";

export const RED = 0xc41230;
const SIDE_PIXELS = 8;

export class TargetView {
  private readonly fill = new THREE.Mesh(
    new THREE.BufferGeometry(),
    new THREE.MeshBasicMaterial({
      color: RED, transparent: true, opacity: 0.55, side: THREE.DoubleSide, depthWrite: false,
      polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2,
    }),
  );
  private readonly outline = new THREE.LineSegments(
    new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: RED, depthTest: false, transparent: true }),
  );
  private readonly corners = new THREE.Points(
    new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ color: RED, size: 11, sizeAttenuation: false, depthTest: false, transparent: true }),
  );
  private readonly fault = new THREE.Points(
    new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ color: 0xffb000, size: 19, sizeAttenuation: false, depthTest: false, transparent: true }),
  );
  private editable: THREE.Vector3[] = [];
  /** what is wrong, and where */
  faulty: { at: THREE.Vector3; reason: string } | null = null;

  constructor(parent: THREE.Object3D, private readonly city: City) {
    [this.fill, this.outline, this.fault, this.corners].forEach((object, i) => {
      object.renderOrder = 3 + i;
      object.frustumCulled = false;
      parent.add(object);
    });
  }

  /** `parts`: convex polygons in the scene frame; `isOpen`: it is being drawn. */
  show(parts: Point[][], options: { isEditable: boolean; isOpen?: boolean; fault?: { at: Point; reason: string } | null }): void {
    const triangles: THREE.Vector3[] = [];
    const sides: THREE.Vector3[] = [];
    const all = parts.map((part) => part.map((p) => this.city.toView(p)));
    for (const part of all) {
      for (let i = 1; i + 1 < part.length; ++i) triangles.push(part[0]!, part[i]!, part[i + 1]!);
      const count = options.isOpen ? part.length - 1 : part.length;
      for (let i = 0; i < count; ++i) sides.push(part[i]!, part[(i + 1) % part.length]!);
    }
    this.fill.geometry.dispose();
    this.fill.geometry = new THREE.BufferGeometry().setFromPoints(options.isOpen ? [] : triangles);
    this.fill.visible = !options.isOpen && triangles.length > 0;
    this.outline.geometry.dispose();
    this.outline.geometry = new THREE.BufferGeometry().setFromPoints(sides);
    this.editable = options.isEditable || options.isOpen ? all.flat() : [];
    this.corners.geometry.dispose();
    const points = all.filter((part) => part.length === 1).flat();
    this.corners.geometry = new THREE.BufferGeometry().setFromPoints(this.editable.length > 0 ? this.editable : points);
    this.faulty = options.fault ? { at: this.city.toView(options.fault.at), reason: options.fault.reason } : null;
    this.fault.geometry.dispose();
    this.fault.geometry = new THREE.BufferGeometry().setFromPoints(this.faulty ? [this.faulty.at] : []);
  }

  /** Index of the corner under the pointer; -1: none. */
  cornerAt(event: Pointer, stage: Stage): number {
    return stage.nearestAt(event, this.editable);
  }

  /** The side under the pointer, from its corner of that index; -1: none. */
  sideAt(event: Pointer, stage: Stage): number {
    const at = stage.onScreen(event);
    const corners = this.editable.map((corner) => stage.project(corner));
    return corners.findIndex((from, i) => {
      const to = corners[(i + 1) % corners.length]!;
      const nearest = new THREE.Line3(from.setZ(0), to.clone().setZ(0)).closestPointToPoint(at, true, new THREE.Vector3());
      return nearest.distanceTo(at) < SIDE_PIXELS;
    });
  }

  isHit(ray: THREE.Raycaster): boolean {
    return this.fill.visible && ray.intersectObject(this.fill, false).length > 0;
  }
}
