#pragma once

namespace catoptric::report {

/// Draws the data of view_3d.h into a page's element "view-3d" by three.js, turned by the mouse. After every
/// turn the picture is kept as an image, which is what a printer gets.
inline constexpr const char* view_script = R"js((function () {
  "use strict";
  const box = document.getElementById("view-3d");
  const data = JSON.parse(document.getElementById("view-3d-data").textContent);
  if (!document.createElement("canvas").getContext("webgl")) {
    box.querySelector(".missing").hidden = false;
    return;
  }
  const renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  const canvas = renderer.domElement;
  box.insertBefore(canvas, box.firstChild);
  const scene = new THREE.Scene();
  const vector = (p) => new THREE.Vector3(p[0], p[1], p[2]);
  const add = (object) => { scene.add(object); return object; };

  function lines(points, material) {
    const geometry = new THREE.BufferGeometry().setFromPoints(points.map(vector));
    const object = add(new THREE.LineSegments(geometry, material));
    if (material.isLineDashedMaterial) object.computeLineDistances();
  }
  function along(polyline) {  // as separate segments
    const ends = [];
    for (let i = 0; i + 1 < polyline.length; ++i) ends.push(polyline[i], polyline[i + 1]);
    return ends;
  }
  const line = (colour) => new THREE.LineBasicMaterial({color: colour});
  const dashed = (colour) => new THREE.LineDashedMaterial(
      {color: colour, dashSize: data.radius / 40, gapSize: data.radius / 60});

  // The mirror: the library revolves about y, the scene about z.
  const profile = data.mirror.map((p) => new THREE.Vector2(p[0], p[1]));
  const turns = 96;
  const skin = add(new THREE.Mesh(
      new THREE.LatheBufferGeometry(profile, turns),
      new THREE.MeshPhongMaterial({color: 0x8fa9c2, side: THREE.DoubleSide, transparent: true, opacity: 0.5,
                                   depthWrite: false, shininess: 60})));
  skin.rotation.x = Math.PI / 2;
  const net = [];
  const around = (p, share) => [p[0] * Math.cos(2 * Math.PI * share), p[0] * Math.sin(2 * Math.PI * share), p[1]];
  const rings = [0, 0.25, 0.5, 0.75, 1].map((share) => data.mirror[Math.round(share * (data.mirror.length - 1))]);
  for (const p of rings)
    for (let i = 0; i < turns; ++i) net.push(around(p, i / turns), around(p, (i + 1) / turns));
  for (let i = 0; i < 12; ++i) net.push(...along(data.mirror.map((p) => around(p, i / 12))));
  lines(net, new THREE.LineBasicMaterial({color: 0x54708c, transparent: true, opacity: 0.6}));

  for (const field of data.fields) {
    for (const outline of field.outlines) lines(along(outline), line(0x7a7a7a));
    if (!field.flat) continue;
    const corners = field.outlines[0], fan = [];
    for (let i = 0; i + 1 < corners.length; ++i) fan.push(field.center, corners[i], corners[i + 1]);
    add(new THREE.Mesh(new THREE.BufferGeometry().setFromPoints(fan.map(vector)),
                       new THREE.MeshBasicMaterial({color: 0x7a7a7a, side: THREE.DoubleSide, transparent: true,
                                                    opacity: 0.25, depthWrite: false})));
  }

  for (const outline of data.objects) lines(along(outline), line(0x009e73));

  for (const path of data.rays) {
    lines(path.slice(0, 2), dashed(0xb87f00));
    lines(along(path.slice(1)), line(0xe69f00));
  }

  const glow = new THREE.MeshBasicMaterial({color: 0xd55e00, side: THREE.DoubleSide});
  for (const source of data.sources) {
    const least = data.radius / 60;
    let geometry = new THREE.SphereBufferGeometry(Math.max(source.radius || 0, least), 24, 16);
    if (source.kind === "disc") geometry = new THREE.CircleBufferGeometry(Math.max(source.radius, least), 48);
    if (source.kind === "rectangle") geometry = new THREE.PlaneBufferGeometry(source.width, source.height);
    if (source.kind === "cylinder")
      geometry = new THREE.CylinderBufferGeometry(source.radius, source.radius, source.length, 32).rotateX(Math.PI / 2);
    const object = add(new THREE.Mesh(geometry, glow));
    const z = vector(source.axis).normalize(), y = new THREE.Vector3().crossVectors(z, vector(source.along)).normalize();
    object.quaternion.setFromRotationMatrix(
        new THREE.Matrix4().makeBasis(new THREE.Vector3().crossVectors(y, z), y, z));
    object.position.copy(vector(source.position));
  }
  const z_axis = [data.center[2] - 0.75 * data.radius, data.center[2] + 0.75 * data.radius];
  lines([[0, 0, z_axis[0]], [0, 0, z_axis[1]]], dashed(0x7a7a7a));

  const camera = new THREE.PerspectiveCamera(30, 1, data.radius / 100, data.radius * 100);
  camera.up.set(0, 0, 1);
  scene.add(camera);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x777788, 0.8));
  const lamp = new THREE.DirectionalLight(0xffffff, 0.5);
  lamp.position.set(0.4, 0.6, 1);
  camera.add(lamp);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;   // arrows scroll the page
  controls.enableZoom = false;   // and so does the wheel, until the view has been touched
  canvas.addEventListener("pointerdown", () => { controls.enableZoom = true; });
  canvas.addEventListener("pointerleave", () => { controls.enableZoom = false; });
  function stand() {
    const narrow = Math.min(1, camera.aspect);
    const distance = 0.8 * data.radius / Math.sin(Math.PI / 12) / narrow;
    controls.target.copy(vector(data.center));
    camera.position.copy(controls.target).add(new THREE.Vector3(0.55, -0.78, data.view_up).normalize().multiplyScalar(distance));
    controls.update();
  }

  const image = box.querySelector("img");
  const draw = () => renderer.render(scene, camera);
  const keep = () => { draw(); image.src = canvas.toDataURL("image/png"); };
  let begun = false;
  function fit() {
    const width = box.clientWidth, height = Math.round(Math.min(520, Math.max(280, 0.65 * width)));
    if (width === 0) return;
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (!begun) stand();
    begun = true;
    keep();
  }
  controls.addEventListener("change", draw);
  controls.addEventListener("end", keep);
  canvas.addEventListener("dblclick", () => { stand(); keep(); });
  window.addEventListener("resize", fit);
  window.addEventListener("beforeprint", keep);
  fit();
})();
)js";

}  // namespace catoptric::report
