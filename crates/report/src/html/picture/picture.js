// The picture of the assembly: turned and zoomed by mouse, touch and keys, with deviations enlarged by a slider. It draws as sheet.rs does.
(() => {
  "use strict";
  const data = JSON.parse(document.getElementById("scene").textContent), section = document.getElementById("picture");
  const stage = section.querySelector(".stage"), tools = section.querySelector(".tools"), slider = tools.querySelector("[data-sigma]");
  const status = tools.querySelector("output"), select = tools.querySelector("select");
  const state = { azimuth: data.view[0], elevation: data.view[1], zoom: 1, sigma: 0, of: data.of };
  const sheets = data.sheets.map((of) => {
    const svg = stage.querySelector(`svg.${of.class}`), part = (name) => svg.querySelector(`.${name}`);
    return { ...of, svg, marks: [...part("marks").children], ghost: part("ghost"), labels: part("labels"), axes: part("axes") };
  });
  const NEAREST = 0.4, FARTHEST = 8, LETTER = 6.4, TALL = 20, DISTANCES = [22, 34, 48, 66, 88], TURNS = [0, 1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6];

  const number = (x) => String(Math.round(10 * x) / 10 + 0), pair = ([x, y]) => `${number(x)} ${number(y)}`;
  /// Place of a point of a body at so many sigma.
  const moved = ([x, y, z], body, sigma) => {
    const all = data.moves[state.of];
    if (sigma === 0 || !all) return [x, y, z];
    const [a, b, c, u, v, w] = all.slice(6 * body, 6 * body + 6), [ox, oy, oz] = data.bodies[body];
    const [rx, ry, rz] = [x - ox, y - oy, z - oz];
    return [x + sigma * (a + v * rz - w * ry), y + sigma * (b + w * rx - u * rz), z + sigma * (c + u * ry - v * rx)];
  };
  const camera = () => {
    const [a, e] = [state.azimuth, state.elevation].map((angle) => angle * Math.PI / 180);
    const right = [-Math.sin(a), Math.cos(a), 0], up = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
    const dot = (p, q) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    return (point) => [dot(right, point), -dot(up, point)];
  };
  const disc = ([x, y], radius) => {
    const r = number(radius), wide = number(2 * radius);
    return `M${pair([x - radius, y])}a${r} ${r} 0 1 0 ${wide} 0a${r} ${r} 0 1 0 -${wide} 0`;
  };
  const dimension = (a, b) => {
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length < 7) return `M${pair([a[0] - 5, a[1] - 5])}l10 10m0-10l-10 10`;
    const u = [(b[0] - a[0]) / length, (b[1] - a[1]) / length], long = Math.min(8, 0.45 * length);
    const head = (end, sign) => {
      const base = [end[0] + sign * long * u[0], end[1] + sign * long * u[1]];
      const corner = (by) => pair([base[0] - 2.8 * by * u[1], base[1] + 2.8 * by * u[0]]);
      return `M${pair(end)}L${corner(1)}L${corner(-1)}Z`;
    };
    return `M${pair(a)}L${pair(b)}${head(a, 1)}${head(b, -1)}`;
  };
  const sides = ([a, b], radius) => {
    const across = [b[0] - a[0], b[1] - a[1]], length = Math.hypot(...across), by = radius / length;
    if (length < 0.5) return "";
    const side = ([x, y], sign) => pair([x - sign * across[1] * by, y + sign * across[0] * by]);
    return `M${side(a, 1)}L${side(b, 1)}M${side(a, -1)}L${side(b, -1)}`;
  };
  const path = ({ form, size }, points, scale) => {
    if (form === "sides") return sides(points, size * scale);
    if (form === "ball") return disc(points[0], size * scale);
    if (form === "dot") return disc(points[0], size);
    if (form === "joint") return `M${pair([points[0][0], points[0][1] - 5])}l5 5-5 5-5-5z`;
    if (form === "size") return dimension(points[0], points[1]);
    let next = 0;
    return [...form].map((letter) => letter + points.slice(next, next += { C: 3, Z: 0 }[letter] ?? 1).map(pair).join(" ")).join("");
  };

  const element = (name, attributes, text) => {
    const made = document.createElementNS(sheets[0].svg.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  /// Labels at places where they overlap least.
  const place = (sheet, project) => {
    const { width, height } = sheet, taken = [[0, height - 68, 68, height]], made = [];
    const labels = data.labels[state.of].map(([kind, text, points]) => {
      const all = points.map(([point, body]) => moved(point, body, state.sigma));
      return { kind, text, at: project([0, 1, 2].map((i) => all.reduce((sum, point) => sum + point[i], 0) / all.length)) };
    });
    for (const { kind, at: [x, y] } of labels) if (kind !== "of-part") taken.push([x - 4, y - 4, x + 4, y + 4]);
    const common = (a, b) => Math.max(0, Math.min(a[2], b[2]) - Math.max(a[0], b[0])) * Math.max(0, Math.min(a[3], b[3]) - Math.max(a[1], b[1]));
    for (const { kind, text, at } of labels) {
      const wide = kind === "balloon" ? TALL : LETTER * [...text].length + 8, outward = Math.atan2(at[1] - 0.5 * height, at[0] - 0.5 * width);
      const boxed = ([x, y]) => [x - 0.5 * wide - 1, y - 0.5 * TALL - 1, x + 0.5 * wide + 1, y + 0.5 * TALL + 1];
      let least = Infinity, best = at;
      for (const distance of DISTANCES) for (const turn of TURNS) {
        const angle = outward + turn * Math.PI / 6;
        const middle = [at[0] + Math.cos(angle) * (distance + 0.5 * (wide - TALL)), at[1] + Math.sin(angle) * distance], own = boxed(middle);
        const outside = (wide + 2) * (TALL + 2) - common(own, [2, 2, width - 2, height - 2]);
        const cost = taken.reduce((sum, other) => sum + common(own, other), 0) + 4 * outside;
        if (cost < least - 1e-9) [least, best] = [cost, middle];
      }
      taken.push(boxed(best));
      const [x, y] = best.map(number), group = element("g", { class: kind });
      if (kind === "balloon") group.append(element("path", { d: `M${pair(at)}L${pair(best)}` }), element("circle", { cx: x, cy: y, r: 10 }));
      group.append(element("text", { x, y: number(best[1] + 4), "text-anchor": "middle" }, text));
      made.push(group);
    }
    sheet.labels.replaceChildren(...made);
  };
  const axes = (sheet, flat) => {
    const origin = [34, sheet.height - 34], made = [];
    for (const [i, name] of ["x", "y", "z"].entries()) {
      const [x, y] = flat([0, 1, 2].map((k) => k === i ? 1 : 0));
      made.push(element("path", { d: `M${pair(origin)}L${pair([origin[0] + 24 * x, origin[1] + 24 * y])}` }));
      made.push(element("text", { x: number(origin[0] + 32 * x), y: number(origin[1] + 32 * y + 4), "text-anchor": "middle" }, name));
    }
    sheet.axes.replaceChildren(...made);
  };
  const draw = () => {
    const flat = camera();
    for (const sheet of sheets) {
      const scale = sheet.scale * state.zoom;
      const project = (point) => { const [x, y] = flat(point); return [sheet.middle[0] + scale * x, sheet.middle[1] + scale * y]; };
      const text = (mark, sigma) => path(mark, mark.points.map((point, i) => project(moved(point, mark.bodies[i] ?? mark.bodies[0], sigma))), scale);
      data.marks.forEach((mark, i) => sheet.marks[i].setAttribute("d", text(mark, state.sigma)));
      sheet.ghost.setAttribute("d", state.sigma === 0 ? "" : data.marks.filter(({ ghost }) => ghost).map((mark) => text(mark, 0)).join(""));
      place(sheet, project);
      axes(sheet, flat);
    }
  };
  let isWaiting = false;
  const update = () => {
    if (!isWaiting) requestAnimationFrame(() => { isWaiting = false; draw(); });
    isWaiting = true;
  };

  const within = (x, least, most) => Math.min(most, Math.max(least, x));
  const turn = (azimuth, elevation) => {
    state.azimuth = (state.azimuth + azimuth) % 360;
    state.elevation = within(state.elevation + elevation, -90, 90);
    update();
  };
  const zoom = (factor) => { state.zoom = within(state.zoom * factor, NEAREST, FARTHEST); update(); };
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  /// Turns to a view, by the shorter way.
  const look = (azimuth, elevation, nearness) => {
    const from = { ...state }, by = ((azimuth - from.azimuth) % 360 + 540) % 360 - 180, start = performance.now(), lasts = calm.matches ? 0 : 200;
    const step = (now) => {
      const part = lasts === 0 ? 1 : within((now - start) / lasts, 0, 1), smooth = part * part * (3 - 2 * part);
      state.azimuth = from.azimuth + by * smooth;
      state.elevation = from.elevation + (elevation - from.elevation) * smooth;
      state.zoom = from.zoom + (nearness - from.zoom) * smooth;
      draw();
      if (part < 1) requestAnimationFrame(step);
    };
    step(start);
  };
  const back = () => look(data.view[0], data.view[1], 1);
  const KEYS = {
    ArrowLeft: () => turn(5, 0), ArrowRight: () => turn(-5, 0), ArrowUp: () => turn(0, 5), ArrowDown: () => turn(0, -5),
    "+": () => zoom(1.2), "=": () => zoom(1.2), "-": () => zoom(1 / 1.2), 0: back, Home: back,
  };
  stage.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(KEYS, event.key)) return;
    event.preventDefault();
    KEYS[event.key]();
  });
  const pointers = new Map();
  const spread = () => { const [a, b] = [...pointers.values()]; return b === undefined ? 0 : Math.hypot(a[0] - b[0], a[1] - b[1]); };
  stage.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    stage.setPointerCapture(event.pointerId);
  });
  stage.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (last === undefined) return;
    const before = spread(), share = 0.5 / pointers.size;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (before > 0) zoom(spread() / before);
    turn(-share * (event.clientX - last[0]), share * (event.clientY - last[1]));
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) stage.addEventListener(name, (event) => pointers.delete(event.pointerId));
  // The page scrolls over the picture, until the picture has the focus.
  stage.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== stage) return;
    event.preventDefault();
    zoom(Math.exp(-0.002 * event.deltaY));
  }, { passive: false });

  const say = () => {
    const of = data.characteristics[state.of], sign = state.sigma > 0 ? "+" : state.sigma < 0 ? "\u2212" : "";
    const value = (of.nominal + state.sigma * of.sigma).toFixed(of.decimals).replace("-", "\u2212");
    const text = state.sigma === 0 ? "nominal" : `${sign}${Math.abs(state.sigma).toFixed(1)} sigma: ${of.name} ${value}${of.unit}, deviations enlarged ${of.enlarged} times`;
    status.textContent = text;
    slider.setAttribute("aria-valuetext", text);
  };
  const show = () => {
    for (const { marks } of sheets) data.marks.forEach(({ owner, measure }, i) => {
      const heat = owner === null ? 0 : data.heat[state.of][owner];
      for (let k = 1; k <= 4; k += 1) marks[i].classList.toggle(`h${k}`, k === heat);
      marks[i].classList.toggle("off", measure !== null && !data.measured[state.of].includes(measure));
    });
    section.querySelectorAll("[data-owners]").forEach((table) => { table.hidden = Number(table.dataset.owners) !== state.of; });
    for (const { svg } of sheets) svg.setAttribute("aria-label", data.characteristics[state.of].words);
    section.querySelector("[data-words]").textContent = data.characteristics[state.of].words;
    slider.closest("label").hidden = !data.moves[state.of];
    if (!data.moves[state.of]) slider.value = state.sigma = 0;
    say();
    draw();
  };
  slider.addEventListener("input", () => { state.sigma = slider.valueAsNumber; say(); update(); });
  select?.addEventListener("change", () => { state.of = Number(select.value); show(); });
  const VIEWS = { front: () => look(-90, 0, state.zoom), side: () => look(0, 0, state.zoom), top: () => look(-90, 90, state.zoom), nearer: () => zoom(1.3), farther: () => zoom(1 / 1.3), back };
  tools.addEventListener("click", ({ target }) => VIEWS[target.dataset.view]?.());
  stage.tabIndex = 0;
  stage.setAttribute("role", "group");
  stage.setAttribute("aria-label", "Picture of the assembly. Arrow keys turn it, plus and minus zoom, 0 goes back.");
  tools.hidden = false;
  // A browser may have kept what was set before the page was loaded again.
  slider.value = 0;
  if (select) select.value = String(state.of);
  show();
})();
