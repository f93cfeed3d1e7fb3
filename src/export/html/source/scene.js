// The picture in space: rail and wheel as bodies, the gap on the rail, the boundary.

import {
    AmbientLight, Box3, Color, DirectionalLight, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial,
    MeshLambertMaterial, PerspectiveCamera, Scene, Vector3, WebGLRenderer, BufferGeometry, Float32BufferAttribute,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { Space } from "./bodies.js";
import { theme } from "./colours.js";
import { Sheet, arrow } from "./dom.js";

/** Half the length of the rail and of the wheel's arc, as multiples of the rail profile's width. */
const REACH = { rail: 1.0, wheel: 1.35 };

/** Room that a picture has around the bodies, as a multiple of theirs. */
const AROUND = 1.08;

/** One turn of the view by a key, rad. */
const TURN = Math.PI / 24;

let shared;

/** The renderer of all pictures: a browser grants a page few of them. `null` where there is no WebGL. */
function renderer() {
    if (shared === undefined) {
        try {
            shared = new WebGLRenderer({ antialias: true, alpha: true });
        } catch {
            shared = null;
        }
    }
    return shared;
}

export class SpaceView {
    constructor(state) {
        this.state = state;
        this.space = new Space(state.contact);
        const label = "Rail, wheel and the gap between them in space. Arrow keys turn the view, page up and down come closer and go away.";
        this.sheet = new Sheet(label, (...to) => this.draw(...to), { tabindex: 0, class: "space" });
        if (!renderer()) return;
        const { grid, pair } = state.contact;
        const x = pair.rail.map((at) => at[0]);
        this.wide = Math.max(...x) - Math.min(...x);
        this.near = Math.max(grid.xi[grid.xi.length - 1] - grid.xi[0], grid.eta[grid.eta.length - 1] - grid.eta[0]);
        this.build();
        this.camera = new PerspectiveCamera(30, 1, 0.02 * this.wide, 50 * this.wide);
        this.camera.up.set(0, 0, 1);
        this.controls = new OrbitControls(this.camera, this.sheet.canvas);
        this.controls.addEventListener("change", () => this.sheet.refresh());
        this.controls.addEventListener("start", () => this.camera.up.set(0, 0, 1));
        // The page scrolls until the picture is clicked or reached by keys.
        this.controls.enableZoom = false;
        this.sheet.canvas.addEventListener("focus", () => (this.controls.enableZoom = true));
        this.sheet.canvas.addEventListener("blur", () => (this.controls.enableZoom = false));
        this.showWheel("half");
        this.look("contact");
    }

    build() {
        const { space, wide } = this;
        this.scene = new Scene();
        this.materials = {
            // Pushed back a little, so that the coloured surface on it hides it.
            rail: new MeshLambertMaterial({
                side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1,
                polygonOffsetUnits: 4,
            }),
            wheel: new MeshLambertMaterial({
                side: DoubleSide, transparent: true, opacity: 0.2, depthWrite: false, forceSinglePass: true,
            }),
            edges: new LineBasicMaterial({ transparent: true, opacity: 0.55 }),
        };
        const surface = new MeshBasicMaterial({
            vertexColors: true, transparent: true, side: DoubleSide, forceSinglePass: true,
        });
        this.rail = new Mesh(space.rail(REACH.rail * wide), this.materials.rail);
        this.wheels = { half: this.wheelFrom(0), whole: this.wheelFrom(-REACH.wheel * wide) };
        this.separation = new Mesh(undefined, surface);
        this.separation.renderOrder = 1;
        this.lines = { boundary: 3.2, cutXi: 1.8, cutEta: 1.8 };
        for (const [name, width] of Object.entries(this.lines)) {
            const material = new LineMaterial({ linewidth: width, transparent: true });
            this.lines[name] = new LineSegments2(new LineSegmentsGeometry(), material);
            this.lines[name].renderOrder = 2;
            this.lines[name].frustumCulled = false;
            this.scene.add(this.lines[name]);
        }
        const light = new DirectionalLight(0xffffff, 2.2);
        light.position.set(-0.5, -0.7, 1);
        const other = new DirectionalLight(0xffffff, 0.9);
        other.position.set(0.8, 0.6, 0.4);
        this.scene.add(this.rail, this.separation, ...Object.values(this.wheels), light, other, new AmbientLight(0xffffff, 1.1));
    }

    /** The wheel from a section to the end of its arc, with the edges of both end faces. */
    wheelFrom(from) {
        const ends = [from, REACH.wheel * this.wide];
        const edges = new BufferGeometry();
        edges.setAttribute("position", new Float32BufferAttribute(this.space.wheelEdges(ends), 3));
        const parts = [new Mesh(this.space.wheel(ends), this.materials.wheel), new LineSegments(edges, this.materials.edges)];
        parts.forEach((part) => (part.renderOrder = 3));
        return new Group().add(...parts);
    }

    /** Turns the view to "contact", "whole" or "above". */
    look(view) {
        if (!this.controls) return;
        const { contact } = this.state;
        const [c, s] = contact.railFrame.turn;
        const normal = new Vector3(-s, 0, c);
        // From the field side at a tread, from the gauge side at a flange: the side that the normal leans to.
        const aside = new Vector3(s > 0.2 ? -0.35 : 0.45, 0, 0);
        const directions = {
            contact: normal.clone().multiplyScalar(0.75).add(new Vector3(0, -1, 0)).add(aside),
            whole: new Vector3(0, -1, 0.32).add(aside),
            above: normal.clone(),
        };
        const direction = directions[view].normalize();
        const bodies = this.bodies();
        const distance = { contact: Math.max(3.4 * this.near, 2 * this.wide), whole: this.fitting(bodies, direction), above: 2.6 * this.near }[view];
        this.controls.target.copy(view === "whole" ? bodies.getCenter(new Vector3()) : new Vector3());
        // Along ζ the picture is turned as the plan beside it, η upwards, until the reader turns it.
        this.camera.up.set(...(view === "above" ? [0, 1, 0] : [0, 0, 1]));
        this.camera.position.copy(direction).multiplyScalar(distance).add(this.controls.target);
        this.controls.update();
        this.sheet.refresh();
    }

    /** The box around the rail and the wheel that is shown. */
    bodies() {
        const box = new Box3().setFromObject(this.rail);
        Object.values(this.wheels).filter((wheel) => wheel.visible).forEach((wheel) => box.expandByObject(wheel));
        return box;
    }

    /** The distance from the middle of a box at which all of it is in the picture, seen from this direction. */
    fitting(box, direction) {
        const { clientWidth: width, clientHeight: height } = this.sheet.canvas;
        const upright = Math.tan(((this.camera.fov / 2) * Math.PI) / 180) / AROUND;
        const across = upright * (width / Math.max(height, 1) || 1);
        const right = new Vector3(0, 0, 1).cross(direction).normalize();
        const up = direction.clone().cross(right);
        const half = box.getSize(new Vector3()).multiplyScalar(0.5);
        const corners = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => new Vector3(x, y, z).multiply(half))));
        return Math.max(...corners.map((at) => at.dot(direction) + Math.max(Math.abs(at.dot(right)) / across, Math.abs(at.dot(up)) / upright)));
    }

    /** Shows the wheel "half", behind the section through C, "whole" or "none". */
    showWheel(shown) {
        if (!this.controls) return;
        for (const [name, wheel] of Object.entries(this.wheels)) wheel.visible = name === shown;
        this.sheet.refresh();
    }

    /** Turns the view by keys; tells whether the key was one of its own. */
    key(event) {
        const turn = arrow(event);
        const step = { PageUp: 0.85, PageDown: 1 / 0.85 }[event.key];
        if (!this.controls || !(turn || step)) return false;
        const { position } = this.camera;
        const { target } = this.controls;
        this.camera.up.set(0, 0, 1);
        const arm = position.clone().sub(target);
        if (step) arm.multiplyScalar(step);
        else {
            const up = new Vector3(0, 0, 1);
            arm.applyAxisAngle(up, TURN * turn[0]);
            const level = new Vector3().crossVectors(up, arm).normalize();
            const lifted = arm.clone().applyAxisAngle(level, -TURN * turn[1]);
            // The view does not turn over at the pole.
            if (lifted.clone().cross(up).length() > 0.02 * lifted.length()) arm.copy(lifted);
        }
        position.copy(target).add(arm);
        this.controls.update();
        this.sheet.refresh();
        return true;
    }

    draw(context, width, height, ratio) {
        const colours = theme();
        const webgl = renderer();
        if (!webgl) {
            context.font = "13px system-ui, sans-serif";
            Object.assign(context, { fillStyle: colours.soft, textAlign: "center" });
            context.fillText("This browser shows no WebGL; the other views do without.", width / 2, height / 2);
            return;
        }
        const { contact, gap, lines, cut } = this.state;
        const { grid } = contact;
        this.colour(gap);
        this.materials.rail.color = new Color(colours.railBody);
        this.materials.wheel.color = new Color(colours.wheelBody);
        this.materials.edges.color = new Color(colours.wheel);
        const lift = 3e-3 * this.near;
        const across = Array.from(grid.xi, (xi) => [xi, cut[1]]);
        const along = [[cut[0], grid.ends(1)[0]], [cut[0], grid.ends(1)[1]]];
        this.put("boundary", lines, 1.5 * lift, colours.boundary, [width, height]);
        this.put("cutXi", [across], lift, colours.cutXi, [width, height]);
        this.put("cutEta", [along], lift, colours.cutEta, [width, height]);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        webgl.setPixelRatio(ratio);
        webgl.setSize(width, height, false);
        webgl.render(this.scene, this.camera);
        context.drawImage(webgl.domElement, 0, 0, width, height);
        this.frame(context, width, height, colours);
    }

    /** Shows a gap in colour. */
    colour(gap) {
        if (this.coloured === gap) return;
        this.coloured = gap;
        this.separation.geometry.dispose();
        this.separation.geometry = this.space.separation(gap);
    }

    /** Puts lines on the rail. */
    put(name, polylines, lift, colour, resolution) {
        const line = this.lines[name];
        const pairs = this.space.onRail(polylines, lift).map((value) => (Number.isNaN(value) ? 0 : value));
        line.visible = pairs.length > 0;
        if (!line.visible) return;
        line.geometry.dispose();
        line.geometry = new LineSegmentsGeometry().setPositions(pairs);
        line.material.color = new Color(colour);
        line.material.resolution.set(...resolution);
    }

    /** Draws the directions of the contact frame at C, with their names. */
    frame(context, width, height, colours) {
        const onScreen = (point) => {
            const at = new Vector3(...this.space.point(point)).project(this.camera);
            return [(0.5 + at.x / 2) * width, (0.5 - at.y / 2) * height];
        };
        const size = this.camera.position.distanceTo(this.controls.target) * 0.11;
        const origin = onScreen([0, 0, 0]);
        context.font = "600 13px system-ui, sans-serif";
        Object.assign(context, { textAlign: "center", textBaseline: "middle", lineJoin: "round" });
        for (const [name, tip] of [["ξ", [size, 0, 0]], ["η", [0, size, 0]], ["ζ", [0, 0, size]]]) {
            const end = onScreen(tip);
            const word = [0, 1].map((k) => origin[k] + 1.22 * (end[k] - origin[k]));
            for (const [colour, wide] of [[colours.paper, 3.5], [colours.ink, 1.5]]) {
                Object.assign(context, { strokeStyle: colour, lineWidth: wide });
                context.beginPath();
                context.moveTo(...origin);
                context.lineTo(...end);
                context.stroke();
            }
            Object.assign(context, { strokeStyle: colours.paper, lineWidth: 3, fillStyle: colours.ink });
            context.strokeText(name, ...word);
            context.fillText(name, ...word);
        }
    }
}
