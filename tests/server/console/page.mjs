// A page without a browser: what the modules of the console draw on the map and write in the panel.
import assert from 'node:assert/strict';
import { copyFileSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

// A copy inside a package, since node takes a .js file outside of one for no module.
const folder = mkdtempSync(join(tmpdir(), 'roadfix-console-'));
writeFileSync(join(folder, 'package.json'), '{"type":"module"}');
for (const name of readdirSync(process.argv[2])) if (name.endsWith('.js')) copyFileSync(join(process.argv[2], name), join(folder, name));
process.on('exit', () => rmSync(folder, { recursive: true }));

export const load = (name) => import(join(folder, name));

/// Figures that are on the map: {kind, at, color ...}, `at` as it was set last.
export const drawn = new Set();

function figure(kind) {
  return (at, style = {}) => {
    const made = {
      kind, at, ...style,
      addTo(layer) { (layer.figures ?? drawn).add(made); drawn.add(made); return made; },
      remove() { drawn.delete(made); return made; },
      bindTooltip: () => made, on: () => made,
      setLatLngs(now) { made.at = now; }, setStyle(now) { Object.assign(made, now); },
    };
    return made;
  };
}

function group() {
  const made = {
    figures: new Set(), addTo: () => made,
    clearLayers() { for (const one of made.figures) drawn.delete(one); made.figures.clear(); },
  };
  return made;
}

globalThis.L = { polyline: figure('line'), polygon: figure('ellipse'), circleMarker: figure('point'), tileLayer: figure('tiles'), layerGroup: group };

export const colours = () => [...drawn].filter(({ kind }) => kind === 'ellipse').map(({ color }) => color);
export const [GREEN, YELLOW, RED] = ['#7ee0a1', '#f4c95d', '#f28b82'];

export const view = {
  middle: 38, moved: null,
  getCenter: () => ({ lat: 37, lng: view.middle }),
  getZoom: () => 12,
  setZoom() {},
  getBounds: () => ({ contains: ([lat, lon]) => Math.abs(lat - 37) < 1 && Math.abs(lon - view.middle) < 1 }),
  setView(at, zoom, { animate }) { assert.equal(animate, false, 'what is drawn while a view flies is beside its place'); view.moved = at; },
};

class Node {
  constructor() {
    Object.assign(this, { children: [], own: '', className: '', options: [], value: '', listeners: {} });
    const classes = new Set();
    this.classList = {
      add: (name) => classes.add(name), contains: (name) => classes.has(name), remove: (...names) => names.forEach((name) => classes.delete(name)),
      toggle: (name, on) => (on ? classes.add(name) : classes.delete(name)),
    };
  }
  get textContent() { return this.own + this.children.map((child) => child.textContent ?? child).join('\n'); }
  set textContent(text) { this.children = []; this.own = text; }
  adopt(nodes) { for (const child of nodes) if (child instanceof Node) child.parent = this; }
  append(...nodes) { this.children.push(...nodes); this.adopt(nodes); }
  prepend(...nodes) { this.children.unshift(...nodes); this.adopt(nodes); }
  replaceChildren(...nodes) { this.own = ''; this.children = []; this.append(...nodes); }
  remove() { this.parent.children = this.parent.children.filter((child) => child !== this); }
  querySelector(selector) { return this.children.find(({ className }) => `.${className}` === selector) ?? null; }
  insertRow() { const row = new Node(); this.append(row); return row; }
  insertCell() { return this.insertRow(); }
  addEventListener(name, act) { this.listeners[name] = act; }
  scrollIntoView() { this.revealed = true; }
  add(option) { this.options.push(option); option.remove = () => { this.options = this.options.filter((one) => one !== option); }; }
}
export const node = () => new Node();

globalThis.document = { createElement: node, addEventListener() {} };
globalThis.Option = class { constructor(text, value) { Object.assign(this, { text, value }); } };
globalThis.setInterval = () => {};

/// Answers by path, or by a function of the request; null: the service cannot be reached; a text: the
/// status of a proxy's error page.
export const service = { answers: {} };
globalThis.fetch = async (url, options) => {
  const answer = service.answers?.[url.split('?')[0]];
  const body = await (typeof answer === 'function' ? answer(url, options) : answer);
  options?.signal?.throwIfAborted();
  if (!body) throw new TypeError('fetch failed');
  if (typeof body === 'string') return { status: Number(body), ok: false, json: async () => JSON.parse('<html>') };
  const status = typeof body.status === 'number' ? body.status : 200;
  return { status, ok: status < 300, json: async () => structuredClone(body) };
};

/// Sends by fetch(); `last` to say how much of it is sent.
export const uploads = { last: null };
globalThis.XMLHttpRequest = class {
  constructor() { Object.assign(this, { upload: {}, headers: {}, given: new AbortController() }); }
  open(method, url) { Object.assign(this, { method, url }); }
  setRequestHeader(name, value) { this.headers[name] = value; }
  abort() { this.given.abort(); this.onabort(); }
  async send(body) {
    uploads.last = this;
    try {
      const answer = await fetch(this.url, { method: this.method, body, headers: this.headers });
      if (this.given.signal.aborted) return;
      this.upload.onload();
      this.responseText = await answer.json().then(JSON.stringify, () => '<html>');
      this.status = answer.status;
      this.onload();
    } catch {
      this.onerror();
    }
  }
};

export async function run(cases) {
  for (const [name, check] of Object.entries(cases)) {
    await check();
    console.log(`ok: ${name}`);
  }
}
