// The operator's console: the maps, a fix for a picture at hand, and whether a place can give a fix. All of it
// is what the HTTP interface offers to any program.
import { square } from './geometry.js';
import { choiceOf, linesOf, stepTo } from './maps.js';
import { drawModes, element, inView, LastQuestion, request, showFix, showProblem, showStatus } from './show.js';
import { Tracks } from './tracks.js';

const by = (id) => document.getElementById(id);
const view = L.map('map', { preferCanvas: true, zoomSnap: 0.5 }).setView([0, 0], 2);
const answers = L.layerGroup().addTo(view);
const localizability = L.layerGroup().addTo(view);
L.control.scale({ imperial: false }).addTo(view);
view.attributionControl.setPrefix('<a href="/console/leaflet-licence.txt">Leaflet</a>');
const MAPS_REFRESH_MS = 10_000;
const mapQuestions = new LastQuestion();
const pictureQuestions = new LastQuestion();
const placeQuestions = new LastQuestion();
const layerQuestions = new LastQuestion();
let shown = null;  // the map on the page, see maps.js
let lines = '';    // of the list of maps, as JSON
let tiles = null;
let layer = null;

/// Runs `work`; what goes wrong is said in `output`, but nothing of what was given up for a newer question.
async function attempt(output, work) {
  try {
    await work();
  } catch (error) {
    if (error.name === 'AbortError') return;
    showProblem(output, error.title ? error : { title: 'The service gives no answer', detail: String(error.message ?? error) });
  }
}

const mapUrl = () => `/v1/maps/${encodeURIComponent(by('maps').value)}`;

/// Draws the chosen map as it is now; gives what the service says of it.
async function drawMap() {
  const url = mapUrl();
  const signal = mapQuestions.next();
  const [info, tileset] = await Promise.all([request(url, { signal }), request(`${url}/tilejson.json`, { signal })]);
  if (tiles) tiles.remove();
  tiles = L.tileLayer(`${url}/tiles/{z}/{x}/{y}.png`, {
    maxNativeZoom: tileset.maxzoom, maxZoom: tileset.maxzoom + 2, attribution: element('span', tileset.attribution).innerHTML,
  }).addTo(view);
  shown = { name: info.name, version: info.version };
  by('about').replaceChildren(
    element('div', `${info.area_km2.toFixed(1)} km² in cells of ${info.cell_m} m, EPSG:${info.epsg}`),
    ...info.sources.map((s) => element('div', [s.name, s.kind, s.date, s.licence].filter(Boolean).join(' · '))));
  return info;
}

async function openMap() {
  pictureQuestions.next();
  placeQuestions.next();
  answers.clearLayers();
  localizability.clearLayers();
  by('answer').replaceChildren();
  by('place').replaceChildren();
  shown = { name: by('maps').value, version: null };
  try {
    const info = await drawMap();
    const [west, south, east, north] = info.bbox;
    view.fitBounds([[south, west], [north, east]]);
    await drawLayer();
  } catch (error) {
    if (error.name !== 'AbortError') shown = null;  // so that the next look at the list tries again
    throw error;
  }
}

/// Keeps the list as the service has it and the choice as the operator left it.
async function showMaps({ maps }) {
  const chosen = choiceOf(maps, by('maps').value);
  const wanted = linesOf(maps, chosen);
  if (lines !== JSON.stringify(wanted)) {
    lines = JSON.stringify(wanted);
    by('maps').replaceChildren(...wanted.map(({ name, text, disabled }) => {
      const option = new Option(text, name);
      option.disabled = disabled;
      return option;
    }));
    by('maps').value = chosen;
  }
  if (chosen === null) by('about').textContent = 'No map is in the folder yet: roadfix ingest makes one.';
  const step = stepTo(maps, chosen, shown);
  if (step === 'open') await openMap();
  if (step === 'redraw') {
    await drawMap();
    await drawLayer();
  }
}

/// A service that does not answer now is asked again.
async function refreshMaps() {
  if (document.hidden) return;
  const list = await request('/v1/maps').catch(() => null);
  if (list) await attempt(by('about'), () => showMaps(list));
}

/// Only numbers of the chosen kind of picture and place count: a mistake in one that is not shown must not hold up others.
function enableChosen(form) {
  const { what, prior } = form.elements;
  for (const input of form.querySelectorAll('[class^=of-] input')) {
    input.disabled = ![what.value, prior.value].some((chosen) => input.parentElement.className === `of-${chosen}`);
  }
}

function questionOf(form) {
  const { picture, what, prior, ...numbers } = Object.fromEntries(form);
  const told = Object.entries(numbers).filter(([, value]) => value !== '');
  const query = new URLSearchParams([['kind', what === 'cells' ? 'feature_map' : 'frame'], ...told]);
  if (prior === 'circle') {
    const { lat, lng } = view.getCenter().wrap();
    query.set('lat', lat);
    query.set('lon', lng);
  }
  return query;
}

async function ask(event) {
  event.preventDefault();
  const form = new FormData(event.target);
  const picture = form.get('picture');
  const signal = pictureQuestions.next();
  answers.clearLayers();
  showStatus(by('answer'), 'searching …', []);
  await attempt(by('answer'), async () => {
    const fix = await request(`${mapUrl()}/fix?${questionOf(form)}`,
      { method: 'POST', body: picture, headers: { 'Content-Type': picture.type }, signal });
    showFix(by('answer'), fix);
    drawModes(view, answers, fix.modes, fix.status);
    if (fix.pose) view.flyTo(inView(view, fix.pose), Math.max(view.getZoom(), 16));
  });
}

async function showLocalizability({ latlng }) {
  if (!tiles) return;
  const side = Number(by('footprint').value);
  const at = latlng.wrap();
  const signal = placeQuestions.next();
  localizability.clearLayers();
  const frame = L.polygon(square([latlng.lat, latlng.lng], side), { color: '#8ab4f8', weight: 2, fill: false }).addTo(localizability);
  showStatus(by('place'), 'looking …', []);
  await attempt(by('place'), async () => {
    const query = new URLSearchParams({ lat: at.lat, lon: at.lng, footprint_m: side });
    const place = await request(`${mapUrl()}/localizability?${query}`, { signal });
    showStatus(by('place'), place.status, [
      place.explanation ?? place.reason,
      `probability ${place.probability.toFixed(3)}, ${(100 * place.road_share).toFixed(0)} % road, ${(100 * place.observed_share).toFixed(0)} % of the ground is on the map`]);
    frame.setStyle({ color: { fix: '#7ee0a1', ambiguous: '#f4c95d', no_fix: '#f28b82' }[place.status] });
    if (place.alike) drawModes(view, localizability, place.alike, 'ambiguous');
  });
}

/// Tiles that are not ready in time are asked for again: the service goes on where it was.
function askAgain({ tile }) {
  const tries = Number(tile.dataset.tries ?? 0);
  if (tries >= 20) return;
  tile.dataset.tries = tries + 1;
  const url = tile.src;
  setTimeout(() => { if (tile.isConnected) tile.src = url; }, 3000);
}

async function drawLayer() {
  const signal = layerQuestions.next();
  if (layer) layer.remove();
  layer = null;
  if (!tiles || !by('layer').checked) return;
  const query = `footprint_m=${Number(by('footprint').value)}`;
  const tileset = await request(`${mapUrl()}/localizability/tilejson.json?${query}`, { signal });
  const [west, south, east, north] = tileset.bounds;
  layer = L.tileLayer(`${mapUrl()}/localizability/tiles/{z}/{x}/{y}.png?${query}`, {
    minZoom: tileset.minzoom, maxNativeZoom: tileset.maxzoom, maxZoom: tiles.options.maxZoom,
    bounds: east > 180 ? null : [[south, west], [north, east]],  // Leaflet would leave out what lies beyond the 180th meridian
  }).on('tileerror', askAgain).addTo(view);
  if (view.getZoom() < tileset.minzoom) view.setZoom(tileset.minzoom);
}

function acceptDrops(target, input) {
  for (const name of ['dragover', 'dragleave', 'drop']) {
    target.addEventListener(name, (event) => {
      event.preventDefault();
      target.classList.toggle('over', name === 'dragover');
      if (name === 'drop') input.files = event.dataTransfer.files;
    });
  }
}

by('maps').addEventListener('change', () => attempt(by('about'), openMap));
by('ask').addEventListener('submit', ask);
by('ask').addEventListener('change', () => enableChosen(by('ask')));
enableChosen(by('ask'));
view.on('click', showLocalizability);
view.on('keypress', ({ originalEvent }) => {
  if (originalEvent.key === 'Enter') showLocalizability({ latlng: view.getCenter() });
});
for (const id of ['layer', 'footprint']) by(id).addEventListener('change', () => attempt(by('place'), drawLayer));
acceptDrops(by('drop'), by('ask').elements.picture);
attempt(by('about'), async () => showMaps(await request('/v1/maps')));
setInterval(refreshMaps, MAPS_REFRESH_MS);
document.addEventListener('visibilitychange', refreshMaps);
window.addEventListener('focus', refreshMaps);
new Tracks(view, by('tracks'), by('track'));
