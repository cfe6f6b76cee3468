// A forest without end: chunks of a Strew daemon around a moving camera, as instanced meshes.
//
// `strew/three` requests chunks, culls them, and draws a part of those that are far away. Chunks come as f32, relative to
// their corner, so no coordinate is large.
import * as THREE from "three";
import { connect } from "strew";
import { Chunks } from "strew/three";

const SIDE = 32; // meters, along each side of a chunk

const parameters = new URLSearchParams(location.search);
const speed = Number(parameters.get("speed") ?? 8); // meters a second
const far = Number(parameters.get("far") ?? 256); // meters; less where no GPU draws
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;

const scene = new THREE.Scene();
scene.background = new THREE.Color(0xb9cbd9);
scene.fog = new THREE.Fog(scene.background, 0.47 * far, 1.1 * far);
scene.add(new THREE.HemisphereLight(0xdde8ff, 0x4a4a2a, 1.6));
const sun = new THREE.DirectionalLight(0xfff1d0, 2);
sun.position.set(-3, 4, -2);
scene.add(sun);
const ground = new THREE.Mesh(
    new THREE.PlaneGeometry(1200, 1200).rotateX(-Math.PI / 2),
    new THREE.MeshLambertMaterial({ color: 0x6b7040 }),
);
scene.add(ground);

const part = (geometry, lift, color) => [geometry.translate(0, lift, 0), new THREE.MeshLambertMaterial({ color })];
const kinds = {
    oak: [part(new THREE.CylinderGeometry(0.12, 0.16, 1, 5), 0.5, 0x5a4632),
        part(new THREE.IcosahedronGeometry(0.9, 1), 1.6, 0x4f8a34)],
    pine: [part(new THREE.ConeGeometry(0.7, 2.8, 7), 1.7, 0x2c6a4a)],
    rock: [part(new THREE.DodecahedronGeometry(0.45), 0.15, 0x8d8a86)],
};

const camera = new THREE.PerspectiveCamera(50, 1, 0.5, 400);
const renderer = new THREE.WebGLRenderer({ antialias: true });
document.body.append(renderer.domElement);
const resize = () => {
    camera.aspect = innerWidth / innerHeight;
    camera.updateProjectionMatrix();
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(innerWidth, innerHeight);
};
addEventListener("resize", resize);
resize();

const url = parameters.get("url") ?? "http://127.0.0.1:8080";
const points = connect(url).points({
    spacing: 2.2, seed: 7, attributes: "angle, scale, variant, rank", scale_range: [0.7, 1.3],
    variants: { oak: 4, pine: 2, rock: 1 }, spread: "even",
});
const chunks = new Chunks(points, kinds, { side: SIDE, near: 0.375 * far, far });
scene.add(chunks.group);
const said = document.querySelector("#said");
const at = { x: Number(parameters.get("x") ?? 0), y: Number(parameters.get("y") ?? 0) };
let before = performance.now();

renderer.setAnimationLoop((now) => {
    if (!still) at.y += speed * Math.min(now - before, 100) / 1000;
    before = now;
    // What is near the origin keeps its precision, however far the walk goes: the camera stays, the world moves.
    const origin = [at.x, at.y].map((v) => SIDE * Math.floor(v / SIDE));
    camera.position.set(at.x - origin[0], 14, -(at.y - origin[1]));
    camera.rotation.set(-0.22, 0, 0);
    chunks.update(camera, origin);
    ground.position.set(camera.position.x, 0, camera.position.z);
    renderer.render(scene, camera);
    const [drawn, loaded] = [chunks.drawn, chunks.loaded].map((count) => count.toLocaleString("en"));
    said.textContent = chunks.error
        ? `The daemon at ${url} does not answer: ${chunks.error.message}`
        : `${drawn} of ${loaded} points in ${chunks.size} chunks`;
    said.dataset.missing = chunks.missing;
});
