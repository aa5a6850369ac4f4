// What the page does with a tileset: show it, style it by cause, pick. `window.view` is what check.mjs calls.
/* global Cesium */
const COLOURS = {  // of the styles: far apart, so that a pixel tells its kind
  scene: [0, 0, 255], range: [255, 128, 0], target_plane: [128, 128, 128], navigation: [0, 160, 0],
  sensor: [255, 0, 255], target: [255, 0, 0],
};

// `only`: the kind that is shown; without it all are.
function style(opacity, only) {
  const conditions = Object.entries(COLOURS).map(([kind, rgb]) => [
    `\${kind} === '${kind}'`, `rgba(${rgb.join(", ")}, ${kind === "target" ? 1 : opacity})`]);
  const color = { conditions: [...conditions, ["true", "color('black')"]] };
  return new Cesium.Cesium3DTileStyle({ color, show: only ? `\${kind} === '${only}'` : "true" });
}

function settled(viewer, tileset) {
  return new Promise((resolve) => {
    let quiet = 0;
    const stop = viewer.scene.postRender.addEventListener(() => {
      quiet = tileset.tilesLoaded ? quiet + 1 : 0;
      if (quiet > 5) { stop(); resolve(); }
    });
  });
}

const vector = (numbers) => new Cesium.Cartesian3(...numbers);

class View {
  static async open(url) {
    const view = new View();
    view.viewer = new Cesium.Viewer("globe", {
      baseLayer: false, baseLayerPicker: false, geocoder: false, animation: false, timeline: false, homeButton: false,
      sceneModePicker: false, navigationHelpButton: false, fullscreenButton: false,
      terrainProvider: new Cesium.EllipsoidTerrainProvider(),
      contextOptions: { webgl: { preserveDrawingBuffer: true } },
    });
    const { scene } = view.viewer;
    scene.globe.baseColor = Cesium.Color.fromCssColorString("#8a9a80");
    scene.fog.enabled = false;
    scene.skyAtmosphere.show = false;
    scene.pickTranslucentDepth = true;
    view.tileset = await Cesium.Cesium3DTileset.fromUrl(url);
    view.tileset.colorBlendMode = Cesium.Cesium3DTileColorBlendMode.REPLACE;  // else the style tints the file's colours
    scene.primitives.add(view.tileset);
    return view;
  }

  // For the picture: from the south-east, from above, with the globe.
  async overview() {
    this.viewer.scene.globe.show = true;
    this.tileset.style = style(0.55);
    const { radius } = this.tileset.boundingSphere;
    await this.viewer.zoomTo(this.tileset, new Cesium.HeadingPitchRange(-0.7, -0.45, 2.1 * radius));
    this.viewer.camera.lookAtTransform(Cesium.Matrix4.IDENTITY);
    await settled(this.viewer, this.tileset);
    return { middle: this.middle(), radius };
  }

  middle() {
    const { center } = this.tileset.boundingSphere;
    return [center.x, center.y, center.z];
  }

  // Looks from one place at another (both ECEF, metres), and says what is in the middle of the picture.
  async pick(from, at, opacity) {
    const { scene, camera } = this.viewer;
    scene.globe.show = false;
    this.tileset.style = style(opacity);
    const direction = Cesium.Cartesian3.normalize(
      Cesium.Cartesian3.subtract(vector(at), vector(from), new Cesium.Cartesian3()), new Cesium.Cartesian3());
    const away = Cesium.Cartesian3.normalize(vector(from), new Cesium.Cartesian3());
    let right = Cesium.Cartesian3.cross(direction, away, new Cesium.Cartesian3());
    if (Cesium.Cartesian3.magnitude(right) < 1e-3) right = Cesium.Cartesian3.cross(direction, Cesium.Cartesian3.UNIT_Z, right);
    const up = Cesium.Cartesian3.normalize(Cesium.Cartesian3.cross(right, direction, right), right);
    camera.setView({ destination: vector(from), orientation: { direction, up } });
    await settled(this.viewer, this.tileset);
    const canvas = scene.canvas;
    const middle = new Cesium.Cartesian2(canvas.clientWidth / 2, canvas.clientHeight / 2);
    const feature = scene.pick(middle);
    const place = scene.pickPosition(middle);
    const get = (name) => (feature?.getProperty ? feature.getProperty(name) : undefined);
    const picked = { kind: get("kind"), name: get("name"), area_m2: get("area_m2"),
      place: place ? [place.x, place.y, place.z] : null };
    return { ...picked, pixel: await this.pixel(picked.kind) };
  }

  // Which style the pixel in the middle has the colour of, with nothing shown but what is of a kind: the facets are
  // translucent, so that others would shine through.
  async pixel(kind) {
    const { scene } = this.viewer;
    this.tileset.style = style(1, kind);
    await settled(this.viewer, this.tileset);
    scene.render();
    const copy = document.createElement("canvas");
    copy.width = copy.height = 1;
    const context = copy.getContext("2d");
    context.drawImage(scene.canvas, scene.canvas.width / 2, scene.canvas.height / 2, 1, 1, 0, 0, 1, 1);
    const hue = (rgb) => rgb.map((value) => value / Math.max(...rgb, 1));  // over black, so that opacity only darkens it
    const seen = hue([...context.getImageData(0, 0, 1, 1).data].slice(0, 3));
    const distance = (rgb) => hue(rgb).reduce((sum, value, i) => sum + (value - seen[i]) ** 2, 0);
    return Object.keys(COLOURS).sort((a, b) => distance(COLOURS[a]) - distance(COLOURS[b]))[0];
  }
}

window.View = View;
window.ready = true;
