// What is dragged: a corner, the polygon, or a handle of a keep-out box.
import * as THREE from "three";
import type { App } from "../app";
import type { Box, Point } from "../engine/messages";
import { centreOf, minus, plus, times, type Plane } from "../model/polygon";
import type { Handle } from "../view/marks";
import type { Pointer } from "../view/stage";

/** Follows the pointer until it is released. */
export type Drag = (event: Pointer) => void;

/** Where the pointer is in a plane (scene frame); null: nowhere near. */
export function onPlane(app: App, event: Pointer, plane: Plane): Point | null {
  const normal = new THREE.Vector3(...plane.normal);
  const flat = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, app.city.toView(plane.origin));
  const { ray } = app.stage.ray(event);
  const found = ray.intersectPlane(flat, new THREE.Vector3());
  if (!found || found.distanceTo(ray.origin) > app.stage.camera.far / 2) return null;
  // Exactly on the plane, whatever the camera's rounding did.
  const at = app.city.toScene(found);
  const off = plane.normal.reduce((sum, n, i) => sum + n * (at[i]! - plane.origin[i]!), 0);
  return minus(at, times(plane.normal, off));
}

function planeOf(app: App, vertices: Point[]): Plane {
  const [a, b, c] = [vertices[0]!, vertices[1]!, vertices[2]!].map((v) => app.city.toView(v)) as
    [THREE.Vector3, THREE.Vector3, THREE.Vector3];
  const { x, y, z } = b.sub(a).cross(c.sub(a)).normalize();
  return { origin: centreOf(vertices), normal: [x, y, z] };
}

/** A corner, or all of the polygon where the pointer is on its inside; null: it is on neither. */
export function dragOfTarget(app: App, event: Pointer, isFillDragged: boolean): Drag | null {
  const target = app.polygon();
  if (!target) return null;
  const corner = app.target.cornerAt(event, app.stage);
  if (corner < 0 && !(isFillDragged && app.target.isHit(app.stage.ray(event)))) return null;
  const { vertices, front } = target;
  const plane = planeOf(app, vertices);
  const from = onPlane(app, event, plane);
  if (!from) return null;
  app.dragged = corner < 0 ? null : corner;
  return (now) => {
    const at = onPlane(app, now, plane);
    if (!at) return;
    const by = minus(at, from);
    const moved = vertices.map((v, i) => (corner < 0 || i === corner ? plus(v, by) : v));
    app.edit((mission) => (mission.target = { kind: "polygon", vertices: moved, ...(front && { front }) }), false);
  };
}

/** How far along a direction the ray passes the point nearest. */
function along(ray: THREE.Ray, point: THREE.Vector3, direction: THREE.Vector3): number {
  const between = point.clone().sub(ray.origin);
  const cosine = direction.dot(ray.direction);
  const sine2 = 1 - cosine * cosine;
  return sine2 < 1e-6 ? 0 : (cosine * ray.direction.dot(between) - direction.dot(between)) / sine2;
}

function resized(box: Box, { axis, end }: Handle, by: number): Box {
  const made = structuredClone(box);
  const least = (box.max[axis as 0]! - box.min[axis as 0]!) / 100;
  made[end][axis as 0] += by;
  if (end === "min") made.min[axis as 0] = Math.min(made.min[axis as 0], box.max[axis as 0] - least);
  else made.max[axis as 0] = Math.max(made.max[axis as 0], box.min[axis as 0] + least);
  return made;
}

export function dragOfBox(app: App, event: Pointer): Drag | null {
  const handle = app.boxes.handleAt(event, app.stage);
  const box = handle && app.mission.keepOut[handle.box];
  if (!box) return null;
  const put = (made: Box) => app.edit((mission) => (mission.keepOut[handle.box] = made), false);
  if (handle.axis === -1) {
    const level: Plane = { origin: app.city.toScene(handle.at), normal: [0, 0, 1] };
    const from = onPlane(app, event, level);
    return (now) => {
      const at = onPlane(app, now, level);
      if (!from || !at) return;
      const by = minus(at, from);
      put({ min: plus(box.min, by), max: plus(box.max, by) });
    };
  }
  const direction = new THREE.Vector3().setComponent(handle.axis, 1);
  const from = along(app.stage.ray(event).ray, handle.at, direction);
  return (now) => put(resized(box, handle, along(app.stage.ray(now).ray, handle.at, direction) - from));
}
