// What the reader does, and the loop that answers it.

// "R_{0}" with its subscripts, superscripts and variables, which stand between U+E000 and U+E001, as elements; the text
// itself is never markup.
function write(element, text) {
  element.replaceChildren();
  for (const part of text.split(/([_^]\{[^}]*\}|\ue000[^\ue001]*\ue001)/)) {
    const script = /^([_^])\{([^}]*)\}$/.exec(part), variable = /^\ue000(.*)\ue001$/.exec(part);
    if (!script && !variable) {
      element.append(part);
      continue;
    }
    const inner = document.createElement(variable ? "em" : script[1] === "_" ? "sub" : "sup");
    write(inner, variable ? variable[1] : script[2]);
    element.append(inner);
  }
}

class Controls {
  constructor(page, data) {
    Object.assign(this, { page, data, camera: new Camera({ ...page.camera, reach: page.reach }), time: 0, playing: false, quality: 1, dirty: true });
    this.element = Object.fromEntries([...document.querySelectorAll("[id]")].map(e => [e.id, e]));
    this.last = page.frames - 1;
    this.style = page.style;
    this.pointers = new Map();
    this.durations = [];
    this.fillIn();
    this.readAddress();
    this.listen();
    this.start();
    requestAnimationFrame(now => this.loop(now));
  }

  fillIn() {
    const { page, element } = this;
    write(element.parameters, page.parameters);
    element.title.textContent = page.title;
    element.scrub.max = this.last;
    element.scrub.disabled = element.play.disabled = this.last === 0;
    for (const [select, rows] of [[element.style, page.styles], [element.view, page.views]])
      for (const row of rows) {
        const option = new Option(row.name, row.name);
        option.title = row.meaning;
        select.append(option);
      }
    document.body.classList.toggle("dark", page.paint.dark);
    if (!page.styles.some(s => s.name === this.style)) this.style = page.styles[0].name;
    if (!page.legend) return;
    const colours = bytesOf(page.legend.colours);
    const stops = Array.from({ length: 256 }, (_, k) => `rgb(${colours[3 * k]} ${colours[3 * k + 1]} ${colours[3 * k + 2]})`);
    element.bar.style.setProperty("--colours", stops.join());
    write(element.bar.querySelector("figcaption"), page.legend.label);
    page.legend.ticks.forEach((share, k) => {
      const item = document.createElement("li");
      item.style.setProperty("--at", `${100 * share}%`);
      write(item, page.legend.texts[k]);
      element.bar.querySelector("ol").append(item);
    });
  }

  // page.html#frame=12&style=ghost&view=along-flow&turn=30,10&zoom=2&play=0&bare&keys
  readAddress() {
    const words = new URLSearchParams(location.hash.slice(1)), number = name => Number.parseFloat(words.get(name));
    if (number("frame") >= 0) this.time = Math.min(number("frame"), this.last);
    if (this.page.styles.some(s => s.name === words.get("style"))) this.style = words.get("style");
    if (words.has("view")) this.look(words.get("view"));
    const [right, up] = (words.get("turn") || "").split(",").map(Number);
    if (Number.isFinite(right) && Number.isFinite(up)) this.camera.turn(right * Math.PI / 180, up * Math.PI / 180);
    if (number("zoom") > 0) this.camera.magnify(number("zoom"));
    document.body.classList.toggle("bare", words.has("bare"));
    this.help(words.has("keys"));
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.play(this.last > 0 && (words.has("play") ? words.get("play") !== "0" : !words.has("frame") && !calm));
  }

  help(on) {
    this.element.keys.hidden = !on;
    this.element.help.setAttribute("aria-expanded", String(on));
  }

  look(name) {
    const view = this.page.views.find(v => v.name === name);
    this.camera.reset(view ? view.axes : undefined);
    this.element.view.value = view ? name : "";
    this.dirty = true;
  }

  start() {
    const canvas = this.element.picture;
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("This browser shows no WebGL 2, which the page needs.");
    this.gl = gl;
    this.scene = new Scene(gl, this.page, this.data);
    this.evaluated = -1;
    this.dirty = true;
  }

  play(on) {
    this.playing = on;
    if (on && this.time >= this.last) this.time = 0;
    this.element.play.textContent = on ? "❚❚" : "▶";
    this.element.play.setAttribute("aria-label", on ? "stop" : "play");
    this.dirty = true;
  }

  go(time) {
    this.time = Math.min(Math.max(time, 0), this.last);
    this.dirty = true;
  }

  paint(name) {
    this.style = name;
    this.dirty = true;
  }

  listen() {
    const { element, camera } = this, canvas = element.picture;
    element.play.onclick = () => this.play(!this.playing);
    element.scrub.oninput = () => {
      this.play(false);
      this.go(Number(element.scrub.value));
    };
    element.style.onchange = () => this.paint(element.style.value);
    element.view.onchange = () => this.look(element.view.value);
    element.help.onclick = () => this.help(element.keys.hidden);
    addEventListener("resize", () => this.dirty = true);
    canvas.addEventListener("webglcontextlost", event => {
      event.preventDefault();
      this.scene = null;
    });
    canvas.addEventListener("webglcontextrestored", () => this.guard(() => this.start()));
    canvas.addEventListener("pointerdown", event => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
    });
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, event => this.pointers.delete(event.pointerId));
    canvas.addEventListener("pointermove", event => this.drag(event));
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("dblclick", () => this.look(""));
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      camera.magnify(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)));
      this.dirty = true;
    }, { passive: false });
    addEventListener("keydown", event => this.key(event));
  }

  drag(event) {
    const { camera, pointers } = this, before = pointers.get(event.pointerId);
    if (!before) return;
    const size = this.size(), x = event.clientX - before.clientX, y = event.clientY - before.clientY;
    if (pointers.size === 2) {
      const other = [...pointers.values()].find(p => p.pointerId !== event.pointerId);
      const distance = p => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
      const angle = p => Math.atan2(p.clientY - other.clientY, p.clientX - other.clientX);
      if (distance(before) > 0) camera.magnify(distance(event) / distance(before));
      camera.roll(angle(event) - angle(before));
      camera.move(x / 2 / size.height, y / 2 / size.height, size);
    } else if (event.shiftKey || before.button === 2 || event.buttons & 6) {
      camera.move(x / size.height, y / size.height, size);
    } else {
      const radians = 3.6 / Math.min(size.width, size.height);
      camera.turn(-radians * x, -radians * y);
    }
    pointers.set(event.pointerId, event);
    this.dirty = true;
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const field = ["INPUT", "SELECT"].includes(event.target.tagName), onButton = event.target.tagName === "BUTTON";
    const styles = this.page.styles.map(s => s.name), step = 0.09, { camera } = this;
    const frame = by => () => {
      this.play(false);
      this.go(Math.round(this.time) + by);
    };
    const actions = {
      "ArrowLeft": () => camera.turn(-step, 0), "ArrowRight": () => camera.turn(step, 0),
      "ArrowUp": () => camera.turn(0, step), "ArrowDown": () => camera.turn(0, -step),
      "+": () => camera.magnify(1.15), "=": () => camera.magnify(1.15), "-": () => camera.magnify(1 / 1.15),
      "[": () => camera.roll(step), "]": () => camera.roll(-step),
      ",": frame(-1), ".": frame(1), "Home": frame(-Infinity), "End": frame(Infinity),
      "s": () => this.paint(styles[(styles.indexOf(this.style) + 1) % styles.length]),
      "r": () => this.look(""),
      "h": () => document.body.classList.toggle("bare"),
      " ": () => this.last > 0 && this.play(!this.playing),
    };
    if (!actions[event.key] || (field && event.key !== " ") || (onButton && event.key === " ")) return;
    event.preventDefault();
    actions[event.key]();
    this.dirty = true;
  }

  // CSS pixels, and samples along each of them.
  size() {
    const width = Math.max(innerWidth, 16), height = Math.max(innerHeight, 16), limit = 4096 / Math.max(width, height);
    return { width, height, scale: Math.min(Math.max(2 * Math.min(devicePixelRatio, 1), devicePixelRatio) * this.quality, limit) };
  }

  // Fewer samples while a slow machine plays, all of them at rest.
  adapt(duration) {
    if (!this.moving) return;
    this.durations.push(duration);
    if (this.durations.length < (duration > 150 ? 2 : 6)) return;  // nobody waits for six slow frames
    const mean = this.durations.reduce((a, b) => a + b) / this.durations.length;
    document.body.dataset.rate = (1000 / mean).toFixed(1);  // frames a second
    this.durations = [];
    if (mean > 45) this.quality = Math.max(0.35, this.quality * Math.min(Math.max(Math.sqrt(45 / mean), 0.4), 0.75));
    else if (mean < 20) this.quality = Math.min(1, this.quality * 1.2);
  }

  loop(now) {
    requestAnimationFrame(later => this.guard(() => this.loop(later)));
    const passed = this.before === undefined ? 0 : now - this.before;
    this.before = now;
    if (!this.scene) return;
    if (this.playing) {
      const speed = Number(this.element.speed.value) * this.last / this.page.seconds;
      this.time += Math.min(passed, 250) / 1000 * speed;
      if (this.time > this.last) this.time = 0;
    }
    const moves = this.playing || this.dirty;
    if (moves && this.moving) this.adapt(passed);
    if (!moves && this.moving && this.quality < 1) {  // the last picture, with all samples
      const reduced = this.quality;
      this.quality = 1;
      this.draw();
      this.quality = reduced;
    } else if (moves) {
      this.draw();
    }
    this.moving = moves;
    this.dirty = false;
  }

  // Boxes of what lies over the picture, CSS pixels; of texts only what is written.
  overlays() {
    const { element } = this, boxes = [element.bar.getBoundingClientRect(), element.keys.getBoundingClientRect(), document.querySelector("footer").getBoundingClientRect()];
    const range = document.createRange();
    for (const text of [element.time, element.parameters, element.title, element.scale, element.bar.querySelector("figcaption"), element.bar.querySelector("ol")]) {
      range.selectNodeContents(text);
      boxes.push(range.getBoundingClientRect());
    }
    boxes.push(document.querySelector("#profile g").getBoundingClientRect(), element.inset.getBoundingClientRect());
    return boxes.filter(box => box.width > 0 && box.height > 0);
  }

  draw() {
    const { element, page, scene, camera } = this, size = this.size(), canvas = element.picture;
    const width = Math.round(size.width * size.scale), height = Math.round(size.height * size.scale);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    if (this.evaluated !== this.time) scene.evaluate(this.time);
    this.evaluated = this.time;
    const radius = size.height / 2 / camera.matrices(size).unit;
    element.scale.style.visibility = radius > 8 && radius < 0.6 * size.width ? "" : "hidden";
    element.scale.querySelector("i").style.width = `${radius}px`;
    write(element.time, page.times[Math.round(this.time)]);
    element.scrub.value = this.time;
    element.style.value = this.style;
    element.bar.hidden = !page.styles.find(s => s.name === this.style).field;
    drawProfile(this, size);
    if (page.inset) drawInset(this, size);
    scene.draw(this.style, camera, size, this.overlays());
    document.body.dataset.drawn = this.time;
  }

  guard(action) {
    try {
      action();
    } catch (error) {
      complain(error);
    }
  }
}

function complain(error) {
  const message = document.getElementById("message");
  message.textContent = error.message;
  message.hidden = false;
}

async function open() {
  const page = JSON.parse(document.getElementById("data").textContent);
  const reader = new SeriesReader(await inflated(bytesOf(page.bytes)), page.frames);
  const vesicles = page.vesicles.map(v => ({ position: reader.next(v.position, 3), labels: reader.next(v.labels, 3),
                                             tracers: reader.next(v.tracers, 3), field: reader.next(v.field, 1) }));
  new Controls(page, { vesicles, arrows: reader.next(page.arrows, 6, 6 * Math.max(...page.arrow_counts)), targets: reader.next(page.targets, 3, 3),
                             profile: reader.next(page.profile, 1), through: reader.next(page.through, 3, 3), insetCentre: reader.next(page.inset_centre, 3, 3) });
}
open().catch(complain);
