// Zones as they are drawn.
import { expect, test } from "@playwright/test";
import * as THREE from "three";
import type { Point, Zone } from "../src/engine/messages";
import type { City } from "../src/view/city";
import { ZonesView } from "../src/view/marks";

test("a zone without room between its heights has an outline and no body", () => {
  const parent = new THREE.Group();
  const city = { toView: ([x, y, z]: Point) => new THREE.Vector3(x, y, z) } as City;
  const view = new ZonesView(parent, city);
  const zone = (low: number, high: number): Zone => ({ kept_out: true, name: "", rings: [[[0, 0], [9, 0], [9, 9]]], low, high });
  for (const [low, high, bodies] of [[0, 60, 1], [60, 60, 0], [60, 5, 0]] as const) {
    view.show([zone(low, high)]);
    expect(view.count).toBe(1);
    expect(parent.children[0]!.children.filter((one) => one instanceof THREE.Mesh).length).toBe(bodies);
  }
});
