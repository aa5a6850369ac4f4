// Renderer, camera, light and ground. Coordinates are metres about the scene's origin, z up.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { SceneInfo } from "../engine/messages";

export const KIND_COLOURS: Record<string, number> = {
  scene: 0x0072b2, range: 0xe69f00, target_plane: 0x808086, navigation: 0x009e73, sensor: 0xcc79a7, unknown: 0x808086,
};

export interface Pointer {
  clientX: number;
  clientY: number;
  pointerType?: string;
}

const BACK = new THREE.Vector3(-0.42, -0.72, 0.56); // from what is looked at to the camera
const POLAR = 0.53 * Math.PI; // a little below the ground, to look up at a bridge

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(45, 1, 0.1, 1e5);
  readonly controls: OrbitControls;
  readonly renderer: THREE.WebGLRenderer;
  private readonly grid = new THREE.Group();
  private isRequested = false;
  private size = 100;
  beforeFrame: (() => void) | null = null;
  onFrame: (() => void) | null = null;
  /** The eye that the view is of has moved. */
  onEye: ((eye: THREE.Vector3) => void) | null = null;
  /** where the camera was before it became an eye */
  private outside: { position: THREE.Vector3; target: THREE.Vector3; fov: number } | null = null;
  /** milliseconds that the last frame took to draw */
  frame_ms = 0;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.localClippingEnabled = true;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = POLAR;
    this.controls.addEventListener("change", () => {
      this.request();
      if (this.outside) this.onEye?.(this.camera.position.clone());
    });
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9a958c, 1.9));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-0.5, -0.8, 1.4);
    this.scene.add(sun, this.grid);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  request(): void {
    if (this.isRequested) return;
    this.isRequested = true;
    requestAnimationFrame(() => {
      this.isRequested = false;
      const start = performance.now();
      this.draw();
      this.frame_ms = performance.now() - start;
      this.onFrame?.();
    });
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement!;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
    this.request();
  }

  /** Looks at all of a scene. */
  frameScene(info: SceneInfo): void {
    const [x, y, z] = [0, 1, 2].map((i) => info.max[i]! - info.min[i]!) as [number, number, number];
    this.size = Math.max(x, y, z, 1e-9);
    this.camera.near = this.size / 2000;
    this.camera.far = this.size * 20;
    this.camera.updateProjectionMatrix();
    this.drawGrid(Math.max(x, y), -z / 2);
    this.lookAt(new THREE.Vector3(0, 0, -z / 2), this.distanceToSee(x / 2, y / 2, z));
  }

  /** From where all of a box is in the picture: half its sides, its height, as lookAt() looks at the middle of its floor. */
  private distanceToSee(x: number, y: number, z: number): number {
    const back = BACK.clone().normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(back).normalize();
    const up = back.clone().cross(right);
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    let distance = 0;
    for (const corner of [[-x, -y], [-x, y], [x, -y], [x, y]].flatMap(([u, v]) => [0, z].map((w) => new THREE.Vector3(u, v, w)))) {
      const across = Math.max(Math.abs(corner.dot(right)) / (slope * this.camera.aspect), Math.abs(corner.dot(up)) / slope);
      distance = Math.max(distance, across + corner.dot(back));
    }
    return (1.05 * distance) / BACK.length();
  }

  lookAt(centre: THREE.Vector3, distance: number): void {
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(BACK.clone().multiplyScalar(distance));
    this.controls.update();
    this.request();
  }

  /** About what is looked at: degrees clockwise and upward; `factor`: of the distance to it. */
  turn(clockwise: number, upward: number, factor = 1): void {
    const { camera, controls } = this;
    const from = camera.position.clone().sub(controls.target);
    const distance = from.length();
    const radians = Math.PI / 180;
    const polar = Math.acos(from.z / distance) - upward * radians;
    const angle = Math.atan2(from.y, from.x) - clockwise * radians;
    // Straight down there would be no direction to turn back to.
    const { sin, cos } = Math;
    const down = Math.max(0.01, Math.min(controls.maxPolarAngle - 0.01, polar));
    from.set(sin(down) * cos(angle), sin(down) * sin(angle), cos(down)).multiplyScalar(distance * factor);
    camera.position.copy(controls.target).add(from);
    controls.update();
  }

  hasEye(): boolean {
    return this.outside !== null;
  }

  /** `fov_deg`: vertical, of a camera. */
  beginEye(eye: THREE.Vector3, centre: THREE.Vector3, fov_deg = 60): void {
    this.outside = { position: this.camera.position.clone(), target: this.controls.target.clone(), fov: this.camera.fov };
    this.controls.maxPolarAngle = Math.PI;
    this.camera.fov = Math.min(120, fov_deg);
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(centre);
    this.moveEye(eye);
  }

  moveEye(eye: THREE.Vector3): void {
    this.camera.position.copy(eye);
    this.controls.update();
    this.request();
  }

  endEye(): void {
    if (!this.outside) return;
    const { position, target, fov } = this.outside;
    this.outside = null;
    this.controls.maxPolarAngle = POLAR;
    this.camera.fov = fov;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.controls.update();
    this.request();
  }

  private drawGrid(extent: number, z: number): void {
    for (const old of this.grid.children) (old as THREE.GridHelper).dispose();
    this.grid.clear();
    const step = 10 ** Math.floor(Math.log10(extent / 5));
    const lines = Math.ceil((extent * 1.4) / step / 2) * 2;
    const helper = new THREE.GridHelper(lines * step, lines, 0x7d8794, 0x7d8794);
    helper.rotateX(Math.PI / 2);
    helper.position.z = z - extent * 1e-4;
    const material = helper.material as THREE.LineBasicMaterial;
    material.transparent = true;
    material.opacity = 0.25;
    this.grid.add(helper);
    this.request();
  }

  /** Degrees clockwise from north that the view's upper side points to. */
  heading(): number {
    const towards = this.controls.target.clone().sub(this.camera.position);
    return (Math.atan2(towards.x, towards.y) * 180) / Math.PI;
  }

  /** Metres of a pixel at the point that the camera turns about. */
  metresPerPixel(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / Math.max(1, this.canvas.clientHeight);
  }

  /** Where a point (view coordinates) is drawn: pixels from the canvas's upper left, and depth, which is below 1. */
  project(point: THREE.Vector3): THREE.Vector3 {
    const at = point.clone().project(this.camera);
    const { clientWidth, clientHeight } = this.canvas;
    return at.set(((at.x + 1) / 2) * clientWidth, ((1 - at.y) / 2) * clientHeight, at.z);
  }

  onScreen(event: Pointer): THREE.Vector3 {
    const box = this.canvas.getBoundingClientRect();
    return new THREE.Vector3(event.clientX - box.left, event.clientY - box.top, 0);
  }

  /** Index of the point under the pointer; -1: none. A finger is wider than a mouse's arrow. */
  nearestAt(event: Pointer, points: THREE.Vector3[]): number {
    const at = this.onScreen(event);
    let best = -1;
    let nearest = event.pointerType === "touch" ? 28 : 14;
    points.forEach((point, i) => {
      const { x, y, z } = this.project(point);
      const distance = Math.hypot(x - at.x, y - at.y);
      if (z >= 1 || distance >= nearest) return;
      nearest = distance;
      best = i;
    });
    return best;
  }

  ray(event: Pointer): THREE.Raycaster {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(
      ((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2,
    );
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster;
  }

  setDark(isDark: boolean): void {
    this.scene.background = new THREE.Color(isDark ? 0x14181f : 0xeef1f4);
    this.request();
  }

  /** Now. */
  draw(): void {
    this.beforeFrame?.();
    this.renderer.render(this.scene, this.camera);
  }
}
