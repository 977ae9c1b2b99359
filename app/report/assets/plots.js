// Draws every <figure class="plot"> of the page from the JSON in it (written by ReportPage::line_plot).
// Hover or tap: values. Drag: zoom; double click: back. Legend: curves off and on.
(function () {
  "use strict";

  // Okabe and Ito 2008, without the yellow that white paper swallows.
  const categorical = ["#20252b", "#0072b2", "#d55e00", "#009e73", "#b4568f", "#c98a00", "#3f9fd8"];
  // Viridis without its lightest end: grows lighter steadily, also in grey print.
  const sequential = d3.scale.linear().domain([0, 0.25, 0.5, 0.75, 1])
    .range(["#440154", "#3f4788", "#2a788e", "#22a07f", "#8fc63d"]).interpolate(d3.interpolateLab);

  const dashes = { line: null, dashes: "7 4" };
  const snapPixels = 30;
  const minimumDragPixels = 6;
  const printWidth = { half: 340, full: 700 };  // of the frame on A4 [px]

  const digits = (value, count) => String(+value.toPrecision(count)).replace("-", "\u2212");
  const axisName = axis => axis.label + (axis.unit ? " [" + axis.unit + "]" : "");
  const isSorted = values => values.every((value, i) => i === 0 || value >= values[i - 1]);

  function padded([low, high], share) {
    const size = high - low || Math.abs(high) || 1;
    return [low - share * size, high + share * size];
  }

  class Plot {
    constructor(figure) {
      this.figure = d3.select(figure);
      this.spec = JSON.parse(figure.querySelector("script").textContent);
      this.canvas = this.figure.select(".canvas");
      this.zoom = null;
      this.wholeRange = !this.spec.window;
      this.prepareCurves();
      this.buildTools();
      this.buildLegend();
      this.readout = this.canvas.append("div").attr("class", "readout").attr("hidden", "");
    }

    // Curves without a name belong to the named one before them.
    prepareCurves() {
      const indices = this.spec.curves.map(curve => curve.colour);
      const low = d3.min(indices), high = d3.max(indices);
      let leader = null;
      this.spec.curves.forEach(curve => {
        if (curve.name || !leader) leader = curve;
        curve.leader = leader;
        curve.visible = true;
        curve.sorted = isSorted(curve.x);
        curve.points = curve.x.map((x, i) => [x, curve.y[i]]);
        curve.paint = this.spec.palette === "sequential"
          ? sequential(high > low ? (curve.colour - low) / (high - low) : 0)
          : categorical[curve.colour % categorical.length];
      });
    }

    get visible() { return this.spec.curves.filter(curve => curve.leader.visible); }

    buildTools() {
      const tools = this.figure.select(".tools");
      const button = (text, action) => tools.append("button").attr("type", "button").text(text)
        .on("click", () => { action(); this.draw(); });
      this.resetButton = button("Reset zoom", () => { this.zoom = null; });
      this.rangeButton = button("", () => { this.wholeRange = !this.wholeRange; this.zoom = null; });
    }

    buildLegend() {
      const legend = this.figure.select(".legend");
      this.spec.curves.filter(curve => curve.name).forEach(curve => {
        const button = legend.append("button").attr("type", "button").attr("aria-pressed", "true")
          .attr("title", "Show or hide");
        const swatch = button.append("svg").attr("viewBox", "0 0 26 12");
        if (curve.lower) swatch.append("rect").attr("width", 26).attr("height", 12).attr("fill", curve.paint).attr("opacity", 0.16);
        if (curve.style === "points") swatch.append("circle").attr({ cx: 13, cy: 6, r: 3.5, fill: curve.paint });
        else swatch.append("line").attr({ x1: 0, x2: 26, y1: 6, y2: 6, stroke: curve.paint, "stroke-width": 2.2 })
          .attr("stroke-dasharray", dashes[curve.style]);
        button.append("span").text(curve.name);
        button.on("click", () => {
          curve.visible = !curve.visible;
          button.attr("aria-pressed", String(curve.visible));
          this.draw();
        });
      });
    }

    // Range of what is visible, before zooming.
    fullDomain() {
      const shown = this.visible.length ? this.visible : this.spec.curves;
      const all = pick => d3.extent(d3.merge(shown.map(pick)));
      const y = !this.wholeRange ? this.spec.window
        : padded(all(curve => curve.lower ? curve.lower.concat(curve.upper) : curve.y), 0.06);
      return { x: padded(all(curve => curve.x), this.spec.equal ? 0.02 : 0.015), y };
    }

    // Equal axes: the height follows from the width; a zoom keeps it and widens what would be distorted.
    fitEqual(domain, width) {
      const full = this.fullDomain(), size = range => range[1] - range[0];
      const height = Math.max(70, Math.min(520, width * size(full.y) / size(full.x)));
      const unitsPerPixel = Math.max(size(domain.x) / width, size(domain.y) / height);
      const around = (range, pixels) => {
        const centre = (range[0] + range[1]) / 2, half = unitsPerPixel * pixels / 2;
        return [centre - half, centre + half];
      };
      return { height, x: around(domain.x, width), y: around(domain.y, height) };
    }

    draw(forcedWidth) {
      const spec = this.spec;
      const outer = forcedWidth || this.canvas.node().clientWidth || 600;
      const height = Math.round(Math.max(210, Math.min(360, outer * 0.62)));
      let domain = this.zoom || this.fullDomain();
      const ticksOf = range => d3.scale.linear().domain(range).ticks(6);
      const widest = d3.max(ticksOf(domain.y), value => digits(value, 6).length) || 1;
      const margin = { top: 24, right: 12, bottom: 40, left: 16 + 7 * widest };
      const width = Math.max(80, outer - margin.left - margin.right);
      let innerHeight = height - margin.top - margin.bottom;
      if (spec.equal) {
        const fitted = this.fitEqual(domain, width);
        innerHeight = fitted.height;
        domain = { x: fitted.x, y: fitted.y };
      }
      this.x = d3.scale.linear().domain(domain.x).range([0, width]);
      this.y = d3.scale.linear().domain(domain.y).range([innerHeight, 0]);
      this.size = { width, height: innerHeight, outer, margin };

      this.resetButton.attr("hidden", this.zoom ? null : "");
      this.rangeButton.attr("hidden", spec.window ? null : "").text(this.wholeRange ? "Close-up" : "Whole range");
      this.hideReadout();
      this.canvas.select("svg").remove();
      const svg = this.canvas.insert("svg", ".readout").attr("role", "img").attr("aria-label", this.figure.select("figcaption span").text())
        .attr("viewBox", [0, 0, outer, innerHeight + margin.top + margin.bottom].join(" "));
      const clip = this.figure.attr("id") + "-clip";
      svg.append("clipPath").attr("id", clip).append("rect").attr({ width, height: innerHeight });
      this.frame = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
      this.drawAxes();
      this.drawCurves(this.frame.append("g").attr("clip-path", `url(#${clip})`));
      this.overlay = this.frame.append("g").style("pointer-events", "none");
      this.listen(svg);
    }

    drawAxes() {
      const { width, height, margin } = this.size;
      const axis = (scale, orient, count, length) => d3.svg.axis().scale(scale).orient(orient)
        .ticks(Math.max(2, count)).innerTickSize(-length).outerTickSize(0).tickPadding(6)
        .tickFormat(value => digits(Math.abs(value) < 1e-9 * d3.max(scale.domain().map(Math.abs)) ? 0 : value, 6));
      this.frame.append("g").attr("class", "axis").attr("transform", `translate(0,${height})`)
        .call(axis(this.x, "bottom", Math.floor(width / 75), height));
      this.frame.append("g").attr("class", "axis").call(axis(this.y, "left", Math.min(8, Math.floor(height / 34)), width));
      const [low, high] = this.y.domain();
      if (low < 0 && high > 0)
        this.frame.append("line").attr({ class: "zero", x1: 0, x2: width, y1: this.y(0), y2: this.y(0) });
      this.frame.append("text").attr({ class: "label", x: width, y: height + 34, "text-anchor": "end" }).text(axisName(this.spec.x));
      this.frame.append("text").attr({ class: "label", x: 6 - margin.left, y: -10 }).text(axisName(this.spec.y));
    }

    drawCurves(group) {
      const line = d3.svg.line().x(d => this.x(d[0])).y(d => this.y(d[1]));
      const band = curve => d3.svg.area().x(i => this.x(curve.x[i]))
        .y0(i => this.y(curve.lower[i])).y1(i => this.y(curve.upper[i]))(d3.range(curve.x.length));
      this.visible.filter(curve => curve.lower).forEach(curve =>
        group.append("path").attr({ d: band(curve), fill: curve.paint, opacity: 0.14 }));
      this.visible.forEach(curve => {
        if (curve.style === "points" || curve.points.length === 1)
          group.selectAll(null).data(curve.points).enter().append("circle")
            .attr({ cx: d => this.x(d[0]), cy: d => this.y(d[1]), r: 3, fill: curve.paint });
        else
          group.append("path").attr({ d: line(curve.points), fill: "none", stroke: curve.paint, "stroke-width": 2, "stroke-linejoin": "round" })
            .attr("stroke-dasharray", dashes[curve.style]);
      });
    }

    listen(svg) {
      const node = svg.node();
      let start = null;
      const place = event => {
        const box = node.getBoundingClientRect(), scale = this.size.outer / box.width;
        const clamp = (value, high) => Math.max(0, Math.min(high, value));
        return [clamp((event.clientX - box.left) * scale - this.size.margin.left, this.size.width),
                clamp((event.clientY - box.top) * scale - this.size.margin.top, this.size.height)];
      };
      node.addEventListener("pointerdown", event => {
        if (event.pointerType !== "touch" && event.button === 0) {
          start = place(event);
          node.setPointerCapture(event.pointerId);
        }
        this.showReadout(place(event));
      });
      node.addEventListener("pointermove", event => start ? this.showSelection(start, place(event)) : this.showReadout(place(event)));
      node.addEventListener("pointerup", event => {
        if (start) this.zoomTo(start, place(event));
        start = null;
      });
      node.addEventListener("pointercancel", () => { start = null; this.hideReadout(); });
      node.addEventListener("pointerleave", event => { if (event.pointerType !== "touch") this.hideReadout(); });
      node.addEventListener("dblclick", () => { this.zoom = null; this.draw(); });
    }

    showSelection(a, b) {
      this.hideReadout();
      this.overlay.append("rect").attr({ class: "selection", x: Math.min(a[0], b[0]), y: Math.min(a[1], b[1]),
        width: Math.abs(a[0] - b[0]), height: Math.abs(a[1] - b[1]) });
    }

    zoomTo(a, b) {
      this.overlay.selectAll("*").remove();
      if (Math.abs(a[0] - b[0]) < minimumDragPixels || Math.abs(a[1] - b[1]) < minimumDragPixels) return;
      const between = (scale, i) => d3.extent([scale.invert(a[i]), scale.invert(b[i])]);
      this.zoom = { x: between(this.x, 0), y: between(this.y, 1) };
      this.draw();
    }

    hideReadout() {
      this.readout.attr("hidden", "");
      if (this.overlay) this.overlay.selectAll("*").remove();
    }

    // Index of the sample of a curve that is nearest on the screen, and how far it is.
    nearest(curve, pixel) {
      let best = { index: -1, distance: Infinity };
      curve.points.forEach((point, index) => {
        const distance = Math.hypot(this.x(point[0]) - pixel[0], this.y(point[1]) - pixel[1]);
        if (distance < best.distance) best = { index, distance };
      });
      return best;
    }

    // What is read at the cursor: all sorted curves at one abscissa (that of the nearest sample), other curves
    // and shapes at their own nearest point.
    readings(pixel) {
      const named = this.visible.filter(curve => curve.name && curve.x.length);
      if (this.spec.equal) {
        const found = named.map(curve => ({ curve, ...this.nearest(curve, pixel) }))
          .filter(one => one.distance < 2 * snapPixels).sort((a, b) => a.distance - b.distance).slice(0, 1);
        return { rows: found.map(one => ({ curve: one.curve, x: one.curve.x[one.index], y: one.curve.y[one.index] })) };
      }
      const at = this.x.invert(pixel[0]);
      const neighbour = curve => {
        const i = d3.bisectLeft(curve.x, at);
        return i > 0 && (i === curve.x.length || at - curve.x[i - 1] < curve.x[i] - at) ? i - 1 : i;
      };
      const sorted = named.filter(curve => curve.sorted);
      const abscissas = sorted.map(curve => curve.x[neighbour(curve)]);
      const x = abscissas.length ? abscissas.reduce((a, b) => Math.abs(b - at) < Math.abs(a - at) ? b : a) : undefined;
      const rows = [];
      named.forEach(curve => {
        const y = curve.sorted ? this.valueAt(curve, x) : undefined;
        if (y !== undefined) rows.push({ curve, y });
        if (curve.sorted) return;
        const near = this.nearest(curve, pixel);
        if (near.distance < snapPixels) rows.push({ curve, x: curve.x[near.index], y: curve.y[near.index] });
      });
      return { x, rows };
    }

    // Lines are interpolated, measured points are not; undefined outside the curve.
    valueAt(curve, x) {
      const i = d3.bisectLeft(curve.x, x);
      if (i === curve.x.length) return undefined;
      if (curve.x[i] === x) return curve.y[i];
      if (i === 0 || curve.style === "points") return undefined;
      const share = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
      return curve.y[i - 1] + share * (curve.y[i] - curve.y[i - 1]);
    }

    showReadout(pixel) {
      this.hideReadout();
      const { x, rows } = this.readings(pixel);
      if (!rows.length) return;
      const { height, width, margin, outer } = this.size;
      const withUnit = (value, axis) => digits(value, 4) + (axis.unit ? "\u00a0" + axis.unit : "");
      if (x !== undefined)
        this.overlay.append("line").attr({ class: "crosshair", x1: this.x(x), x2: this.x(x), y1: 0, y2: height });
      this.readout.html("");
      if (x !== undefined) this.readout.append("div").text(this.spec.x.label + ": " + withUnit(x, this.spec.x));
      const table = this.readout.append("table");
      rows.forEach(({ curve, x: own, y }) => {
        const cx = this.x(own === undefined ? x : own), cy = this.y(y);
        if (cy >= 0 && cy <= height && cx >= 0 && cx <= width)
          this.overlay.append("circle").attr({ cx, cy, r: 4, fill: "#fff", stroke: curve.paint, "stroke-width": 2 });
        const row = table.append("tr"), name = row.append("td");
        name.append("i").style("background", curve.paint);
        name.append("span").text(curve.name);
        row.append("td").text((own === undefined ? "" : withUnit(own, this.spec.x) + ", ") + withUnit(y, this.spec.y));
      });
      this.readout.attr("hidden", null);
      const box = this.readout.node(), scale = this.canvas.node().clientWidth / outer;
      const left = (margin.left + pixel[0]) * scale;
      const room = this.canvas.node().clientWidth - box.offsetWidth;
      this.readout.style("left", Math.max(0, left + 16 <= room ? left + 16 : left - 16 - box.offsetWidth) + "px")
        .style("top", Math.max(0, (margin.top + pixel[1]) * scale - box.offsetHeight - 12) + "px");
    }
  }

  const plots = Array.from(document.querySelectorAll("figure.plot"), figure => new Plot(figure));
  const drawAll = () => plots.forEach(plot => plot.draw());
  drawAll();
  let width = window.innerWidth, timer = 0;
  window.addEventListener("resize", () => {
    if (window.innerWidth === width) return;  // a phone's address bar comes and goes
    width = window.innerWidth;
    clearTimeout(timer);
    timer = setTimeout(drawAll, 120);
  });
  window.addEventListener("beforeprint", () =>
    plots.forEach(plot => plot.draw(plot.figure.classed("full") ? printWidth.full : printWidth.half)));
  window.addEventListener("afterprint", drawAll);
})();
