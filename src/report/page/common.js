"use strict";
// What the pages share: their data, and how elements are made.
const vigia = (() => {
  const $ = (id) => document.getElementById(id);
  const data = JSON.parse($("data").textContent);
  $("title").textContent = data.title;
  $("subtitle").textContent = data.subtitle;

  function fill(made, attributes, children) {
    for (const [key, value] of Object.entries(attributes || {})) {
      if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
      else if (key === "class") made.setAttribute("class", value);
      else made.setAttribute(key, value);
    }
    for (const child of children) made.append(child);
    return made;
  }
  const element = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);
  const drawing = (tag, attributes, ...children) => fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

  /// The style's colours by their names, for what is not styled by it.
  function readColours() {
    const style = getComputedStyle(document.documentElement), colours = {};
    for (const name of ["paper", "ink", "muted", "rule", "wall", "solid", "floor", "truth", "planned",
                        "accent", "mark", "view", "field", "line", "c0", "c1", "c2", "c3", "c4", "c5"])
      colours[name] = style.getPropertyValue("--" + name).trim();
    return colours;
  }
  const ready = () => { document.documentElement.dataset.ready = "yes"; };
  return { $, data, element, drawing, readColours, ready };
})();
