#include "app/report/html_sections.h"

namespace lodestone {

namespace {

// What the page does besides being read; without it all is shown but the stage and the switch.
constexpr std::string_view kScript = R"js('use strict';
(function () {
  const byId = (id) => document.getElementById(id);
  const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

  function setUpTheme() {
    const root = document.documentElement;
    const button = byId('theme');
    const system = window.matchMedia('(prefers-color-scheme: light)');
    const isLight = () => (root.dataset.theme || (system.matches ? 'light' : 'dark')) === 'light';
    const show = () => { button.textContent = isLight() ? 'Dark' : 'Light'; };
    button.hidden = false;
    button.addEventListener('click', () => {
      root.dataset.theme = isLight() ? 'dark' : 'light';
      show();
    });
    system.addEventListener('change', show);
    show();
  }

  function setUpStage() {
    const stage = byId('stage');
    if (!stage) return;
    const view = byId('view');
    const over = byId('over');
    const divider = byId('divider');
    const images = [byId('side-a'), byId('side-b')];
    const tags = [byId('tag-a'), byId('tag-b')];
    const kMostZoom = 16;
    let split = 0.5;
    let mode = 'wipe';
    let shown = 1; // while flickering: 0 is A, 1 is B
    let timer = 0;
    let zoom = 1;
    let x = 0; // of the picture's corner, in widths and heights of the view
    let y = 0;

    function draw() {
      const flicker = mode === 'flicker';
      const left = flicker ? (shown === 1 ? 0 : 1) : split;
      over.style.clipPath = 'inset(0 0 0 ' + 100 * left + '%)';
      divider.style.left = 100 * split + '%';
      tags[0].hidden = flicker ? shown !== 0 : split < 0.08;
      tags[1].hidden = flicker ? shown !== 1 : split > 0.92;
      stage.classList.toggle('flicker', flicker);
      view.classList.toggle('zoomed', zoom > 1);
      const transform = 'translate(' + 100 * x + '%,' + 100 * y + '%) scale(' + zoom + ')';
      images.forEach((image) => { image.style.transform = transform; });
    }

    function pick(side, index) {
      const picture = byId('picture-' + index);
      images[side].src = picture.src;
      images[side].alt = picture.alt;
      tags[side].textContent = picture.dataset.name;
      document.querySelector('input[name=side-' + 'AB'[side] + '][value="' + index + '"]').checked = true;
      draw();
    }

    function setMode(next) {
      mode = next;
      clearInterval(timer);
      stage.querySelectorAll('[data-mode]').forEach((button) => {
        button.setAttribute('aria-pressed', String(button.dataset.mode === mode));
      });
      const still = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
      if (mode === 'flicker' && !still)
        timer = setInterval(() => { shown = 1 - shown; draw(); }, 700);
      draw();
    }

    // Keeps the point (u, v) of the view where it is.
    function zoomTo(next, u, v) {
      next = clamp(next, 1, kMostZoom);
      x = clamp(u - (u - x) * next / zoom, 1 - next, 0);
      y = clamp(v - (v - y) * next / zoom, 1 - next, 0);
      zoom = next;
      draw();
    }

    function pan(dx, dy) {
      x = clamp(x + dx, 1 - zoom, 0);
      y = clamp(y + dy, 1 - zoom, 0);
      draw();
    }

    function at(event) {
      const box = view.getBoundingClientRect();
      return { u: (event.clientX - box.left) / box.width, v: (event.clientY - box.top) / box.height };
    }

    const pointers = new Map();
    let drags = '';
    view.addEventListener('pointerdown', (event) => {
      view.setPointerCapture(event.pointerId);
      const point = at(event);
      const box = view.getBoundingClientRect();
      const near = Math.abs(point.u - split) * box.width <= 24;
      drags = mode === 'wipe' && (near || zoom === 1) ? 'divider' : 'picture';
      pointers.set(event.pointerId, point);
    });
    view.addEventListener('pointermove', (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const point = at(event);
      if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const length = (p) => Math.hypot(p.u - other.u, p.v - other.v);
        zoomTo(zoom * length(point) / Math.max(length(before), 0.01), other.u, other.v);
      } else if (drags === 'divider') {
        split = clamp(point.u, 0, 1);
        draw();
      } else {
        pan(point.u - before.u, point.v - before.v);
      }
      pointers.set(event.pointerId, point);
    });
    ['pointerup', 'pointercancel'].forEach((name) => {
      view.addEventListener(name, (event) => { pointers.delete(event.pointerId); });
    });
    view.addEventListener('dblclick', (event) => {
      const point = at(event);
      zoomTo(zoom >= 8 ? 1 : zoom * 2.5, point.u, point.v);
    });
    view.addEventListener('wheel', (event) => {
      if (zoom === 1 && !event.ctrlKey) return; // the page scrolls
      event.preventDefault();
      const point = at(event);
      zoomTo(zoom * Math.exp(-0.0016 * event.deltaY), point.u, point.v);
    }, { passive: false });
    const keys = {
      ArrowLeft: () => { split = clamp(split - 0.02, 0, 1); },
      ArrowRight: () => { split = clamp(split + 0.02, 0, 1); },
      ' ': () => {
        if (mode === 'flicker') { clearInterval(timer); shown = 1 - shown; return; }
        split = split > 0.5 ? 0 : 1;
      },
      '+': () => { zoomTo(zoom * 1.5, 0.5, 0.5); },
      '-': () => { zoomTo(zoom / 1.5, 0.5, 0.5); },
      '0': () => { zoomTo(1, 0.5, 0.5); }
    };
    keys['='] = keys['+'];
    view.addEventListener('keydown', (event) => {
      if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
      draw();
    });
    byId('closer').addEventListener('click', keys['+']);
    byId('farther').addEventListener('click', keys['-']);
    byId('whole').addEventListener('click', keys['0']);
    stage.querySelectorAll('[data-mode]').forEach((button) => {
      button.addEventListener('click', () => { setMode(button.dataset.mode); });
    });
    stage.querySelectorAll('input').forEach((input) => {
      input.addEventListener('change', () => { pick(input.name === 'side-A' ? 0 : 1, input.value); });
    });
    document.querySelectorAll('[data-pick]').forEach((link) => {
      link.addEventListener('click', () => { pick(1, link.dataset.pick); });
    });
    stage.hidden = false;
    [0, 1].forEach((side) => {
      pick(side, document.querySelector('input[name=side-' + 'AB'[side] + ']:checked').value);
    });
  }

  // Pointing at a name of the legend brings its lines out.
  function setUpLegend() {
    const legend = document.querySelector('.legend');
    const charts = document.querySelector('.charts');
    if (!legend || !charts) return;
    function focus(series) {
      [legend, charts].forEach((part) => {
        part.classList.toggle('focused', series !== null);
        part.querySelectorAll('[data-series]').forEach((one) => {
          one.classList.toggle('focus', one.dataset.series === series);
        });
      });
    }
    [legend, charts].forEach((part) => {
      part.addEventListener('pointerover', (event) => {
        const one = event.target.closest('[data-series]');
        focus(one ? one.dataset.series : null);
      });
      part.addEventListener('pointerleave', () => { focus(null); });
    });
  }

  setUpTheme();
  setUpStage();
  setUpLegend();
})();
)js";

} // namespace

std::string pageScript() {
    return std::string(kScript);
}

} // namespace lodestone
