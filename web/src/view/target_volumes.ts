// The volumes of the targets of a flight, each in a colour of its own: from within it all of its target is seen.
import * as THREE from "three";
import type { ViewMesh } from "../engine/messages";

/** None of the flight's colours, and not the targets'. */
const COLOURS = [0x0072b2, 0x009e73, 0xcc79a7, 0x56b4e9, 0xb8a100, 0x7b1fa2, 0x6d4c41, 0x26c6da];

export const colourOf = (target: number): number => COLOURS[target % COLOURS.length]!;

export class TargetVolumesView {
  private readonly mesh = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({
    vertexColors: true, transparent: true, opacity: 0.32, side: THREE.DoubleSide, depthWrite: false, flatShading: true,
  }));

  constructor(parent: THREE.Object3D) {
    this.mesh.visible = false;
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
    parent.add(this.mesh);
  }

  /** `labels` of the mesh: the targets. */
  show({ positions, triangles, labels }: ViewMesh): void {
    const corners = new Float32Array(3 * triangles.length);
    const colours = new Float32Array(3 * triangles.length);
    triangles.forEach((vertex, i) => {
      corners.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i);
      new THREE.Color(colourOf(labels[Math.floor(i / 3)]!)).toArray(colours, 3 * i);
    });
    this.mesh.geometry.dispose();
    this.mesh.geometry = new THREE.BufferGeometry();
    this.mesh.geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    this.mesh.geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    this.mesh.visible = true;
  }

  hide(): void {
    this.mesh.visible = false;
  }

  get isShown(): boolean {
    return this.mesh.visible;
  }
}
