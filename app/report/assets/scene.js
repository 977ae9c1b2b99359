// Scenes: a motion in three dimensions, with a slider and a time line of what happened. Drawn by three.js; where the browser has
// no WebGL, as two flat views.
(function () {
  "use strict";
  const wireColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
  function colourOf(item, index) {
    return item.kind === "wire" ? wireColours[index % wireColours.length] : item.kind === "arm" ? "#222222" : "#8a8a8a";
  }

  // Three.js: wires as tubes, all else as lines.
  function spatial(stage, data, canvas, context) {
    const renderer = new THREE.WebGLRenderer({ antialias: true, canvas: canvas, context: context });
    renderer.setPixelRatio(window.devicePixelRatio || 1);
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0xffffff);
    scene.add(new THREE.AmbientLight(0xffffff, 0.7));
    const camera = new THREE.PerspectiveCamera(35, 1, 1, 1e7);
    const light = new THREE.DirectionalLight(0xffffff, 0.5);
    camera.add(light);
    scene.add(camera);
    camera.up.set(0, 0, 1);
    const controls = new THREE.OrbitControls(camera, renderer.domElement);
    let thickness = 1;

    function points(line) {
      const all = [];
      for (let i = 0; i < line.length; i += 3) all.push(new THREE.Vector3(line[i], line[i + 1], line[i + 2]));
      return all;
    }
    function segments(lines) {
      const ends = [];
      lines.forEach(function (line) {
        const all = points(line);
        for (let i = 0; i + 1 < all.length; ++i) ends.push(all[i], all[i + 1]);
      });
      return new THREE.BufferGeometry().setFromPoints(ends);
    }
    function tube(line) {
      const all = points(line), path = new THREE.CurvePath();
      for (let i = 0; i + 1 < all.length; ++i) {
        if (all[i].distanceTo(all[i + 1]) > 0) path.add(new THREE.LineCurve3(all[i], all[i + 1]));
      }
      if (path.curves.length === 0) return new THREE.BufferGeometry();
      return new THREE.TubeBufferGeometry(path, Math.max(16, 2 * all.length), thickness, 6);
    }
    function object(item, index, lines) {
      const colour = new THREE.Color(colourOf(item, index));
      const made = item.kind === "wire" ? new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({ color: colour }))
        : new THREE.LineSegments(segments(lines), new THREE.LineBasicMaterial({ color: colour }));
      made.frustumCulled = false;
      scene.add(made);
      return made;
    }
    const moving = data.moving.map(function (item, i) { return object(item, i, []); });
    const carried = data.carried.map(function (item, i) { return object(item, i, item.lines); });
    function render() { renderer.render(scene, camera); }
    controls.addEventListener("change", render);
    return {
      thickness: function (value) { thickness = value; },
      show: function (frame) {
        frame.moving.forEach(function (lines, i) {
          moving[i].geometry.dispose();
          moving[i].geometry = data.moving[i].kind === "wire" ? tube(lines[0]) : segments(lines);
        });
        frame.poses.forEach(function (p, i) {
          carried[i].position.set(p[0], p[1], p[2]);
          carried[i].quaternion.set(p[3], p[4], p[5], p[6]);
        });
        render();
      },
      look: function (box) {
        const middle = new THREE.Vector3(box.middle[0], box.middle[1], box.middle[2]);
        controls.target.copy(middle);
        camera.position.copy(middle).add(new THREE.Vector3(0.9, -1.3, 0.8).normalize().multiplyScalar(2.2 * box.reach));
        camera.near = 1e-3 * box.reach;
        camera.far = 1e4 * box.reach;
        camera.updateProjectionMatrix();
        controls.update();
        render();
      },
      shift: function (by) {
        const v = new THREE.Vector3(by[0], by[1], by[2]);
        controls.target.add(v);
        camera.position.add(v);
        controls.update();
      },
      resize: function (width, height) {
        renderer.setSize(width, height);
        camera.aspect = width / height;
        camera.updateProjectionMatrix();
        render();
      }
    };
  }

  // Two views side by side: along z with x to the right, along x with z to the right; y is up.
  function flat(stage, data, canvas) {
    const context = canvas.getContext("2d");
    let frame = data.frames[0], middle = [0, 0, 0], reach = 1, width = 1, height = 1;
    function turned(p, x, y, z) {  // by the quaternion of a pose, and shifted
      const a = p[3], b = p[4], c = p[5], w = p[6];
      const u = 2 * (b * z - c * y), v = 2 * (c * x - a * z), t = 2 * (a * y - b * x);
      return [p[0] + x + w * u + b * t - c * v, p[1] + y + w * v + c * u - a * t, p[2] + z + w * t + a * v - b * u];
    }
    function stroke(lines, colour, lineWidth, pose) {
      context.strokeStyle = colour;
      context.lineWidth = lineWidth;
      [0, 2].forEach(function (across, view) {
        const scale = 0.5 * Math.min(0.5 * width, height) / (0.6 * reach);
        context.save();
        context.beginPath();
        context.rect(0.5 * width * view, 0, 0.5 * width, height);
        context.clip();
        context.beginPath();
        lines.forEach(function (line) {
          for (let i = 0; i < line.length; i += 3) {
            const at = pose ? turned(pose, line[i], line[i + 1], line[i + 2]) : line.slice(i, i + 3);
            const x = (0.25 + 0.5 * view) * width + scale * (at[across] - middle[across]);
            const y = 0.5 * height - scale * (at[1] - middle[1]);
            if (i) context.lineTo(x, y); else context.moveTo(x, y);
          }
        });
        context.stroke();
        context.restore();
      });
    }
    function render() {
      context.clearRect(0, 0, width, height);
      frame.poses.forEach(function (p, i) { stroke(data.carried[i].lines, colourOf(data.carried[i], i), 1, p); });
      frame.moving.forEach(function (lines, i) {
        stroke(lines, colourOf(data.moving[i], i), data.moving[i].kind === "wire" ? 2 : 1, null);
      });
    }
    return {
      thickness: function () {},
      show: function (next) { frame = next; render(); },
      look: function (box) { middle = box.middle.slice(); reach = box.reach; render(); },
      shift: function (by) { middle = middle.map(function (m, c) { return m + by[c]; }); },
      resize: function (w, h) { canvas.width = width = w; canvas.height = height = h; render(); }
    };
  }

  function start(figure) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const stage = figure.querySelector(".stage"), slider = figure.querySelector("input[type=range]");
    const label = figure.querySelector("output"), play = figure.querySelector(".play");
    const follow = figure.querySelector("input[type=checkbox]"), line = figure.querySelector(".marks");
    const canvas = document.createElement("canvas");
    stage.appendChild(canvas);
    const context = canvas.getContext("webgl") || canvas.getContext("experimental-webgl");
    const view = context ? spatial(stage, data, canvas, context) : flat(stage, data, canvas);
    if (!context) figure.querySelector(".note").textContent = "Left along z with x to the right, right along x with z to the right; y is up. "
      + "In a browser with WebGL this is one view that can be turned.";

    const isWire = function (item) { return item.kind === "wire"; };
    const hasWires = data.moving.some(isWire);
    // The middle and the size of chosen items of a frame.
    function box(k, chosen, places) {
      const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
      function take(values, i) {
        for (let c = 0; c < 3; ++c) {
          low[c] = Math.min(low[c], values[i + c]);
          high[c] = Math.max(high[c], values[i + c]);
        }
      }
      data.frames[k].moving.forEach(function (lines, item) {
        if (chosen(data.moving[item])) lines.forEach(function (l) { for (let i = 0; i < l.length; i += 3) take(l, i); });
      });
      if (places) data.frames[k].poses.forEach(function (p) { take(p, 0); });
      return {
        middle: low.map(function (l, c) { return 0.5 * (l + high[c]); }),
        reach: Math.max(1, Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]))
      };
    }
    function wires(k) { return box(k, isWire, false); }
    function whole(k) { return box(k, function () { return true; }, true); }

    let shown = 0;
    function show(k) {
      if (hasWires && follow.checked && k !== shown) {
        const now = wires(k).middle, before = wires(shown).middle;
        view.shift(now.map(function (m, c) { return m - before[c]; }));
      }
      shown = k;
      view.show(data.frames[k]);
      label.textContent = data.frames[k].label;
      slider.value = k;
    }

    // The time line: a mark leads to its moment.
    const from = data.frames[0].time, span = data.frames[data.frames.length - 1].time - from;
    data.marks.forEach(function (mark) {
      const button = document.createElement("button");
      button.type = "button";
      button.title = mark.text + ", " + Number(mark.time.toPrecision(6)) + " s";
      button.setAttribute("aria-label", button.title);
      button.className = mark.text.split(":")[0].replace(" ", "-");
      button.style.left = (span > 0 ? 100 * Math.min(1, Math.max(0, (mark.time - from) / span)) : 0) + "%";
      button.addEventListener("click", function () {
        let nearest = 0;
        data.frames.forEach(function (f, k) {
          if (Math.abs(f.time - mark.time) < Math.abs(data.frames[nearest].time - mark.time)) nearest = k;
        });
        show(nearest);
      });
      line.appendChild(button);
    });

    slider.max = data.frames.length - 1;
    slider.addEventListener("input", function () { show(Number(slider.value)); });
    let timer = null;
    play.addEventListener("click", function () {
      if (timer) {
        clearInterval(timer);
        timer = null;
        play.textContent = "play";
        return;
      }
      play.textContent = "stop";
      timer = setInterval(function () { show((Number(slider.value) + 1) % data.frames.length); }, 50);
    });
    figure.querySelector(".near").addEventListener("click", function () { view.look(wires(shown)); });
    figure.querySelector(".far").addEventListener("click", function () { view.look(whole(shown)); });
    if (!hasWires) {
      figure.querySelector(".near").remove();
      follow.parentNode.remove();
    }
    function resize() {
      const width = stage.clientWidth;
      view.resize(width, Math.round(Math.min(0.62 * width, 480)));
    }
    window.addEventListener("resize", resize);
    const first = hasWires ? wires(0) : whole(0);
    view.thickness(0.004 * first.reach);
    show(0);
    view.look(first);
    resize();
  }

  document.querySelectorAll("figure.scene").forEach(start);
})();
