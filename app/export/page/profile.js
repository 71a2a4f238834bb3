// The profile of the background flow at the left edge, where the picture is seen as filmed; as draw_flow_profile() of the
// program.

function drawProfile({ page, data, camera, element, time }, { width, height }) {
  const group = element.profile.querySelector("g"), text = Number.parseFloat(getComputedStyle(element.profile).fontSize);
  group.replaceChildren();
  const speeds = numbersAt(data.profile, time, []), count = speeds.length;
  if (count < 2 || !speeds.some(v => v !== 0) || !camera.asFilmed()) return;
  // As far up and down as texts leave room.
  const above = Math.max(element.parameters.getBoundingClientRect().bottom, element.title.getBoundingClientRect().bottom) + 2.2 * text;
  const below = element.scale.getBoundingClientRect().top - 0.8 * text, { profile_reach, profile_width } = page.paint;
  const half = height / 2 * page.camera.half_height / camera.matrices({ width, height }).unit, line = half * profile_reach;  // px
  const least = Math.min(0, ...speeds), most = Math.max(0, ...speeds), margin = Math.min(1.5 * 16, width / 12);
  // Beside what the vesicles reach in the course of the movie: not in narrow windows.
  const room = width / 2 - page.reach * page.paint.bodies_width * half - margin - text, wide = Math.min(profile_width * width, room);
  if (wide < 3 * text) return;
  const scale = wide / Math.max(most - least, 0.5), axis = margin - scale * least;
  const points = Array.from(speeds, (v, k) => [axis + scale * v, height / 2 - line * (2 * k / (count - 1) - 1)])
    .filter(([, y]) => y >= above && y <= below);
  if (points.length < 2 || points[0][1] - points[points.length - 1][1] < 0.2 * height / 2) return;
  const add = (name, attributes, content = "") => {
    const made = document.createElementNS(group.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(content);
    group.append(made);
    return made;
  };
  const bottom = points[0][1], top = points[points.length - 1][1];
  let arrows = "";
  points.forEach(([x, y], k) => {
    const way = Math.sign(x - axis), head = Math.min(0.45 * text, Math.abs(x - axis));
    if (k % 4 === 0 && head > 0.5) arrows += `M${axis} ${y}H${x}M${x - way * head} ${y - head / 2}L${x} ${y}L${x - way * head} ${y + head / 2}`;
  });
  add("path", { d: `M${axis} ${bottom}V${top}${arrows}` });
  add("path", { class: "curve", "stroke-width": 1.6, d: points.map(([x, y], k) => `${k ? "L" : "M"}${x} ${y}`).join("") });
  const name = add("text", { x: axis, y: top - 0.7 * text });
  for (const [part, attributes] of [["u", { "font-style": "italic" }], ["∞", { dy: 0.2 * text, "font-size": "70%" }]])
    name.append(add("tspan", attributes, part));
}
