// Animations: outlines over time, drawn to scale, with a slider. No library.
(function () {
  "use strict";
  const colours = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9"];
  document.querySelectorAll("figure.animation").forEach(function (figure) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const svg = figure.querySelector("svg");
    const slider = figure.querySelector("input");
    const label = figure.querySelector("output");
    const button = figure.querySelector("button");
    const names = figure.querySelector(".animation-names");
    const box = data.box;  // x0, y0, width, height; y upwards
    svg.setAttribute("viewBox", [0, 0, box[2], box[3]].join(" "));
    const paths = data.names.map(function (name, i) {
      const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
      path.setAttribute("fill", "none");
      path.setAttribute("stroke", colours[i % colours.length]);
      path.setAttribute("stroke-width", 1.6);
      path.setAttribute("vector-effect", "non-scaling-stroke");
      svg.appendChild(path);
      const entry = document.createElement("span");
      entry.textContent = "\u2014 " + name;
      entry.style.color = colours[i % colours.length];
      names.appendChild(entry);
      return path;
    });
    function show(k) {
      const frame = data.frames[k];
      frame.outlines.forEach(function (outline, i) {
        let d = "";
        outline.forEach(function (line) {
          for (let j = 0; j < line.length; j += 2) {
            d += (j ? "L" : "M") + (line[j] - box[0]) + " " + (box[1] + box[3] - line[j + 1]);
          }
        });
        paths[i].setAttribute("d", d);
      });
      label.textContent = frame.label;
      slider.value = k;
    }
    slider.max = data.frames.length - 1;
    slider.addEventListener("input", function () { show(Number(slider.value)); });
    let timer = null;
    button.addEventListener("click", function () {
      if (timer) {
        clearInterval(timer);
        timer = null;
        button.textContent = "play";
        return;
      }
      button.textContent = "stop";
      timer = setInterval(function () { show((Number(slider.value) + 1) % data.frames.length); }, 50);
    });
    show(0);
  });
})();
