// The section of all membranes with the plane y = that of the movie's middle; as draw_inset() of the program.

// Where it is free: at the right of the upper edge, else beside the colour bar, below the texts, or nowhere.
function placeOfInset({ page, element }, boxes, { width, height }) {
  const { aspect, height: share } = page.inset, gap = Math.min(12, height / 40);
  const high = Math.min(share * height, 0.38 * width / aspect), wide = aspect * high;
  const bar = element.bar.hidden ? [] : [element.bar, element.bar.querySelector("figcaption")].map(e => e.getBoundingClientRect());
  const left = Math.min(width, ...bar.filter(b => b.top < high + 2 * gap).map(b => b.left)) - gap;
  const lowest = Math.max(0, ...[element.time, element.parameters, element.title].map(e => e.getBoundingClientRect().bottom));
  const free = box => boxes.every(b => box.left >= b.right + gap || b.left >= box.right + gap || box.top >= b.bottom + gap || b.top >= box.bottom + gap);
  const places = [[width - gap - wide, gap], [left - wide, gap], [width - gap - wide, lowest + gap], [left - wide, lowest + gap]];
  return places.map(([x, y]) => ({ left: x, top: y, right: x + wide, bottom: y + high }))
    .find(box => box.left >= gap && box.bottom < height / 2 && free(box));
}

function drawInset(controls, size) {
  const { page, data, scene, element, time } = controls, { inset } = element;
  inset.style.display = "none";  // it is not in its own way
  const place = placeOfInset(controls, controls.overlays(), size);
  if (!place) return;
  inset.style.display = "";
  const wide = place.right - place.left, high = place.bottom - place.top, scale = high / (2 * page.inset.half_height);
  const [x, , z] = numbersAt(data.insetCentre, time, []), arrow = 14, head = 4, name = 11;
  Object.assign(inset.style, { left: `${place.left}px`, top: `${place.top}px`, width: `${wide}px`, height: `${high}px` });
  const spot = p => `${(wide / 2 + scale * (p[0] - x)).toFixed(1)} ${(high / 2 - scale * (p[2] - z)).toFixed(1)}`;
  const add = (tag, attributes, content = "") => {
    const made = document.createElementNS(inset.namespaceURI, tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(content);
    return made;
  };
  const curves = scene.sections().map(({ vesicle, curves }) => {
    const path = add("path", { fill: vesicle.section, d: curves.map(curve => `M${curve.map(spot).join("L")}Z`).join("") });
    path.style.setProperty("--own", vesicle.section);
    return path;
  });
  const foot = [8, high - 8], axes = `M${foot[0] + arrow} ${foot[1]}H${foot[0]}V${foot[1] - arrow}M${foot[0] + arrow - head} ${foot[1] - head / 2}l${head} ${head / 2}l${-head} ${head / 2}M${foot[0] - head / 2} ${foot[1] - arrow + head}l${head / 2} ${-head}l${head / 2} ${head}`;
  inset.replaceChildren(...curves, add("path", { class: "axes", d: axes }), add("text", { x: foot[0] + arrow + 3, y: foot[1] + 3, "font-size": name }, "x"),
                        add("text", { x: foot[0] - 3, y: foot[1] - arrow - 4, "font-size": name }, "z"));
}
