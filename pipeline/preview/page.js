"use strict";
(() => {
    const $ = id => document.getElementById(id);
    const canvas = $("canvas"), context = canvas.getContext("2d");
    const page = Math.random().toString(36).slice(2);
    const kPaintedAlone = 64;          // tiles of an answer; of more the whole rectangle is painted at once
    const kMostBytes = 512 * 2 ** 20;  // of layers that are fetched though nobody looks at them

    // Two pictures: the one that is made, and the one before it. A picture has `facts` as /state tells them,
    // `planes` of floats by the names of channels, `versions` of layers that it has, and `cube`, its view.
    let now = null, before = null, pinned = false;
    let layer = "RGB", exposure = 0, status = null;
    let pointed = null;  // the pixel whose values are shown

    const key = (run, facts) => run + "/" + facts.number;
    const picture = (run, facts) => ({key: key(run, facts), run, facts, planes: {}, versions: {}, cube: null});
    const sizes = facts => [facts.window[2] - facts.window[0], facts.window[3] - facts.window[1]];

    // Layers: channels by what they are called before the last dot; colours of the picture are one.
    function layersOf(channels) {
        const layers = new Map([["RGB", ["R", "G", "B"]], ["A", ["A"]], ["Z", ["Z"]]]);
        for (const channel of channels) {
            const dot = channel.lastIndexOf(".");
            if (dot < 0) continue;
            const name = channel.slice(0, dot);
            layers.set(name, [...(layers.get(name) || []), channel]);
        }
        return layers;
    }
    const channelsOf = (of, name) => layersOf(of.facts.channels).get(name) || [];
    const isColour = channels => channels.length === 3 && channels.every(c => /(^|\.)[RGB]$/.test(c));

    // From values to what a screen shows.
    const curve = new Uint8ClampedArray(16385);
    for (let i = 0; i < curve.length; ++i) {
        const v = (i / 16384) ** 2;
        curve[i] = Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
    }
    const encoded = v => curve[v > 0 ? v < 1 ? Math.round(Math.sqrt(v) * 16384) : 16384 : 0];

    function throughCube(cube, rgb, out, at) {
        const {side, toe, most, table} = cube, scale = (side - 1) / Math.log2(most / toe + 1);
        const place = [0, 0, 0], part = [0, 0, 0];
        for (let c = 0; c < 3; ++c) {
            const v = Math.min(Math.max(rgb[c], 0), most) || 0;
            const x = Math.log2(v / toe + 1) * scale;
            place[c] = Math.min(side - 2, Math.floor(x));
            part[c] = x - place[c];
        }
        for (let c = 0; c < 3; ++c) {
            let sum = 0;
            for (let corner = 0; corner < 8; ++corner) {
                const r = corner & 1, g = (corner >> 1) & 1, b = corner >> 2;
                const weight = (r ? part[0] : 1 - part[0]) * (g ? part[1] : 1 - part[1]) * (b ? part[2] : 1 - part[2]);
                sum += weight * table[3 * (((place[2] + b) * side + place[1] + g) * side + place[0] + r) + c];
            }
            out[at + c] = Math.round(255 * sum);
        }
    }

    // The least and greatest finite value of some channels.
    function rangeOf(of, channels) {
        let low = Infinity, high = -Infinity;
        for (const channel of channels)
            for (const v of of.planes[channel] || [])
                if (Number.isFinite(v)) low = v < low ? v : low, high = v > high ? v : high;
        return low < high ? [low, high] : [Number.isFinite(low) ? low - 1 : 0, Number.isFinite(low) ? low : 1];
    }

    // Of both pictures where they lie side by side: one grey is one value.
    function sharedRange() {
        let low = Infinity, high = -Infinity;
        for (const of of comparable() ? [now, before] : [now]) {
            const channels = channelsOf(of, layer);
            if (!channels.length || channels.some(c => !of.planes[c])) continue;
            of.range = of.range || rangeOf(of, channels);
            low = Math.min(low, of.range[0]), high = Math.max(high, of.range[1]);
        }
        return [low, high];
    }

    function painter(of) {
        const channels = channelsOf(of, layer), planes = channels.map(c => of.planes[c]);
        if (!channels.length || planes.some(p => !p)) return null;
        const gain = 2 ** exposure, cube = $("view").checked ? of.cube : null, rgb = [0, 0, 0];
        if (isColour(channels))
            return (i, out, at) => {
                for (let c = 0; c < 3; ++c) rgb[c] = planes[c][i] * gain;
                if (cube) throughCube(cube, rgb, out, at);
                else for (let c = 0; c < 3; ++c) out[at + c] = encoded(rgb[c]);
            };
        const [low, high] = layer === "A" ? [0, 1] : sharedRange();
        const shown = v => Number.isFinite(v) ? 255 * (v - low) / (high - low) : 0;
        return (i, out, at) => {
            for (let c = 0; c < 3; ++c) out[at + c] = shown(planes[planes.length === 3 ? c : 0][i]);
        };
    }

    // Paints a rectangle of the window: what is left of the divider is of the picture before.
    function paint(x0, y0, x1, y1) {
        if (x0 >= x1 || y0 >= y1) return;
        const [left, top] = now.facts.window, [width] = sizes(now.facts);
        const image = context.createImageData(x1 - x0, y1 - y0), out = image.data;
        const of = [painter(now), comparable() ? painter(before) : null];
        const divider = comparable() ? left + Number($("split").value) * width : -Infinity;
        const here = [now, before].map((p, k) => of[k] && p.planes[channelsOf(p, layer)[0]]);
        for (let y = y0, at = 0; y < y1; ++y)
            for (let x = x0, i = (y - top) * width + x0 - left; x < x1; ++x, ++i, at += 4) {
                const which = x < divider ? 1 : 0;
                if (!of[which] || Number.isNaN(here[which][i])) continue;
                of[which](i, out, at);
                out[at + 3] = 255;
            }
        context.putImageData(image, x0, y0);
    }
    function paintAll() {
        if (!now) return;
        now.range = null;
        if (before) before.range = null;
        paint(...now.facts.window);
        const split = Number($("split").value), [width] = sizes(now.facts);
        $("divider").hidden = !comparable() || split <= 0 || split >= 1;
        $("divider").style.left = now.facts.window[0] + split * width + "px";
    }
    let painting = false;
    function paintSoon() {
        if (painting) return;
        painting = true;
        requestAnimationFrame(() => { painting = false; paintAll(); });
    }
    const comparable = () => before && before.facts.width === now.facts.width &&
        before.facts.height === now.facts.height && String(before.facts.window) === String(now.facts.window);

    // What the server has.
    async function bytes(path) {
        const answer = await fetch(path, {cache: "no-store"});
        if (!answer.ok) throw new Error(path + ": " + answer.status);
        return answer.arrayBuffer();
    }
    async function fetchLayer(of, name) {
        const channels = channelsOf(of, name), [width, height] = sizes(of.facts), [left, top] = of.facts.window;
        for (const channel of channels)
            of.planes[channel] = of.planes[channel] || new Float32Array(width * height).fill(NaN);
        for (;;) {
            const after = of.versions[name] || 0;
            const answer = await bytes(`tiles?picture=${of.facts.number}&after=${after}&channels=${encodeURIComponent(channels.join(","))}&page=${page}`);
            const view = new DataView(answer), floats = new Float32Array(answer);
            const count = Number(view.getBigUint64(0, true));
            let at = 16, x0 = Infinity, y0 = Infinity, x1 = -Infinity, y1 = -Infinity;
            for (let t = 0; t < count; ++t) {
                const [x, y, w, h] = [0, 4, 8, 12].map(k => view.getInt32(at + k, true));
                at += 16;
                for (const channel of channels)
                    for (let row = 0; row < h; ++row, at += 4 * w)
                        of.planes[channel].set(floats.subarray(at / 4, at / 4 + w), (y - top + row) * width + x - left);
                if (of !== now || name !== layer) continue;
                if (!isColour(channels) && layer !== "A") paintSoon();
                else if (count <= kPaintedAlone) paint(x, y, x + w, y + h);
                else x0 = Math.min(x0, x), y0 = Math.min(y0, y), x1 = Math.max(x1, x + w), y1 = Math.max(y1, y + h);
            }
            paint(x0, y0, x1, y1);
            if (of === now && pointed) read(...pointed);
            of.versions[name] = Number(view.getBigUint64(8, true));
            if (count === 0) return;
        }
    }
    async function fetchCube(of) {
        const {view} = of.facts;
        if (!view || of.cube) return;
        of.cube = {...view, table: new Float32Array(await bytes(`view?picture=${of.facts.number}&page=${page}`))};
        paintSoon();
    }
    async function fetchAll(of) {
        const [width, height] = sizes(of.facts);
        const fits = 4 * width * height * of.facts.channels.length <= kMostBytes;
        for (const name of layersOf(of.facts.channels).keys())
            if (fits || of.versions[name] || name === layer) await fetchLayer(of, name);
        of.complete = of.facts.version;
    }

    function begin(run, facts) {
        if (now && Object.keys(now.versions).length && !(pinned && before)) before = now;
        now = picture(run, facts);
        if (canvas.width !== facts.width || canvas.height !== facts.height) {
            canvas.width = facts.width, canvas.height = facts.height;
            fit();
        }
        context.clearRect(0, 0, canvas.width, canvas.height);
        const names = [...layersOf(facts.channels).keys()];
        if (!names.includes(layer)) layer = "RGB";
        $("layer").replaceChildren(...names.map(name => new Option(name, name, false, name === layer)));
        $("empty").hidden = true;
        paintAll();
        if (pointed) read(...pointed);
    }

    // How far it is.
    const clock = s => s >= 3600 ? `${Math.floor(s / 3600)}:${String(Math.floor(s / 60) % 60).padStart(2, "0")}:${String(Math.floor(s) % 60).padStart(2, "0")}`
        : `${Math.floor(s / 60)}:${String(Math.floor(s) % 60).padStart(2, "0")}`;
    // To those who listen: not every percent.
    function say(text) {
        if ($("told").textContent !== text) $("told").textContent = text;
    }
    function tellOfNewRun() {
        if (status.ended || (now && status.run === now.run)) return;
        const text = `${now ? "a new run: " : ""}${status.stage}`;
        say(text);
        $("stage").textContent = text;
        document.title = "Trapeze";
    }
    function tell(gone) {
        if (!now) return;
        const facts = now.facts, done = facts.finished, broken = facts.closed && !done;
        $("name").textContent = facts.name;
        $("facts").textContent = `${facts.width}×${facts.height}` + (facts.frame ? `, frame ${facts.frame}` : "");
        $("progress").value = done ? 1 : status.fraction;
        const left = status.left === null || status.left === undefined ? "" : `, about ${clock(status.left)} left`;
        say(done ? "finished" : broken || gone ? "broken off" : status.stage);
        $("stage").textContent = done ? "finished" : broken || gone ? "broken off"
            : `${status.stage}, ${Math.floor(100 * status.fraction)} %, ${clock(status.seconds)}${left}`;
        document.title = (done || broken || gone ? "" : `${Math.floor(100 * status.fraction)} % `) + facts.name;
        const view = facts.view;
        $("view-label").hidden = !view;
        if (view) $("view-name").textContent = `${view.display}, ${view.view}` + (view.look ? `, ${view.look}` : "");
        $("comparing").hidden = !comparable();
    }

    const wait = ms => new Promise(resolve => setTimeout(resolve, ms));
    async function watch() {
        let version = 0, run = null;
        for (;;) {
            try {
                const have = now && now.run === run && now.complete ? `${now.facts.number}.${now.complete}` : "";
                const answer = await fetch(`state?after=${version}&page=${page}&have=${have}`, {cache: "no-store"});
                status = await answer.json();
                if (status.run !== run) version = 0;
                run = status.run, version = status.version;
                const facts = status.picture;
                if (!facts) tellOfNewRun();
                if (facts) {
                    if (!now || now.key !== key(run, facts)) {
                        // What is left of the one before is still there for a while.
                        if (now && now.run === run) await fetchAll(now).catch(() => {});
                        begin(run, facts);
                    }
                    now.facts = facts;
                    tell(false);
                    await fetchCube(now);
                    await fetchLayer(now, layer);
                    if (facts.closed) await fetchAll(now);
                }
                if (status.ended && (!now || now.complete === now.facts.version)) {
                    // The server learns that it may go, and a later run takes its place.
                    if (have) await wait(1000);
                }
            } catch (problem) {
                tell(!now || !now.facts.closed);
                version = 0;
                await wait(1000);
            }
        }
    }

    // Where the picture lies.
    let scale = 1, x = 0, y = 0;
    function place() {
        $("paper").style.transform = `translate(${x}px, ${y}px) scale(${scale})`;
        $("zoom").textContent = Math.round(100 * scale) + " %";
    }
    function enlargeTo(wanted, atX, atY) {
        const next = Math.min(64, Math.max(1 / 16, wanted));
        x = atX - (atX - x) * next / scale, y = atY - (atY - y) * next / scale;
        scale = next;
        place();
    }
    function centre() {
        x = Math.round((stand.clientWidth - scale * canvas.width) / 2);
        y = Math.round((stand.clientHeight - scale * canvas.height) / 2);
        place();
    }
    function fit() {
        scale = Math.min(stand.clientWidth / canvas.width, stand.clientHeight / canvas.height, 8);
        fitted = true;
        centre();
    }
    let fitted = true;
    const stand = $("stand");
    new ResizeObserver(() => { if (fitted) fit(); }).observe(stand);
    stand.addEventListener("wheel", event => {
        event.preventDefault();
        fitted = false;
        enlargeTo(scale * 2 ** (-event.deltaY / 300), ...pointOf(event));
    }, {passive: false});
    function pointOf(event) {
        const box = stand.getBoundingClientRect();
        return [event.clientX - box.left, event.clientY - box.top];
    }
    // The mouse or the fingers that hold the picture, and where they were last.
    const held = new Map();
    function hold(event) {
        // Also where it leaves the stand.
        stand.setPointerCapture(event.pointerId);
        held.set(event.pointerId, pointOf(event));
    }
    stand.addEventListener("pointerdown", event => { if (event.button === 0) hold(event); });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
        stand.addEventListener(end, event => { held.delete(event.pointerId); });
    // One moves the picture, two enlarge it too.
    function drag(from, to, other) {
        fitted = false;
        const part = other ? 0.5 : 1;
        x += part * (to[0] - from[0]), y += part * (to[1] - from[1]);
        if (!other) return place();
        const distance = at => Math.max(1, Math.hypot(at[0] - other[0], at[1] - other[1]));
        enlargeTo(scale * distance(to) / distance(from), (to[0] + other[0]) / 2, (to[1] + other[1]) / 2);
    }
    stand.addEventListener("pointermove", event => {
        // A button that is pressed or let go while another is down says so by a move.
        if (!(event.buttons & 1)) held.delete(event.pointerId);
        else if (event.button === 0) hold(event);
        const to = pointOf(event), from = held.get(event.pointerId);
        if (from && (to[0] !== from[0] || to[1] !== from[1])) {
            const others = [...held].filter(([id]) => id !== event.pointerId);
            if (others.length < 2) drag(from, to, others.length ? others[0][1] : null);
            held.set(event.pointerId, to);
        }
        read(Math.floor((to[0] - x) / scale), Math.floor((to[1] - y) / scale));
    });
    stand.addEventListener("keydown", event => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const middle = [stand.clientWidth / 2, stand.clientHeight / 2];
        const moves = {ArrowLeft: [64, 0], ArrowRight: [-64, 0], ArrowUp: [0, 64], ArrowDown: [0, -64]}[event.key];
        if (moves) x += moves[0], y += moves[1], place();
        else if (event.key === "+" || event.key === "=") enlargeTo(2 * scale, ...middle);
        else if (event.key === "-") enlargeTo(scale / 2, ...middle);
        else if ((event.key === "b" || event.key === "B") && now && comparable()) {
            $("split").value = Number($("split").value) > 0.5 ? 0 : 1;
            paintAll();
            return;
        } else return;
        fitted = false;
        event.preventDefault();
    });
    $("fit").addEventListener("click", fit);
    $("actual").addEventListener("click", () => { fitted = false, scale = 1, centre(); });

    // Values of a pixel.
    function values(of, px, py) {
        const [left, top] = of.facts.window, [width] = sizes(of.facts), i = (py - top) * width + px - left;
        return Object.keys(of.planes).filter(c => !Number.isNaN(of.planes[c][i]))
            .map(c => [c, Number(of.planes[c][i].toPrecision(6))]);
    }
    function fill(element, label, pairs) {
        element.replaceChildren(label, ...pairs.flatMap(([name, value]) => {
            const b = document.createElement("b");
            b.textContent = name + " ";
            return [b, String(value)];
        }));
    }
    function read(px, py) {
        pointed = [px, py];
        if (!now) return;
        const [x0, y0, x1, y1] = now.facts.window;
        const inside = px >= x0 && px < x1 && py >= y0 && py < y1;
        fill($("pixel"), inside ? `${px}, ${py}` : "Outside of the picture", inside ? values(now, px, py) : []);
        $("pixel-before").hidden = !inside || !comparable();
        if (inside && comparable()) fill($("pixel-before"), "before", values(before, px, py));
    }

    $("layer").addEventListener("change", async () => {
        layer = $("layer").value;
        paintAll();
        try { await fetchLayer(now, layer); } catch (problem) { /* the program is gone: there is what there is */ }
        paintAll();
    });
    $("exposure").addEventListener("input", () => {
        exposure = Number($("exposure").value);
        $("stops").textContent = (exposure > 0 ? "+" : "") + exposure;
        paintSoon();
    });
    $("view").addEventListener("change", paintSoon);
    $("split").addEventListener("input", paintSoon);
    $("pin").addEventListener("click", () => {
        pinned = !pinned;
        $("pin").setAttribute("aria-pressed", String(pinned));
    });
    watch();
})();
