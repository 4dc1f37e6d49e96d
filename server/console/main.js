// The operator's console: the maps, a fix for a picture at hand, whether a place can give a fix, and tracks. All of it
// is what the HTTP interface offers to any program.
import { hashOf, shownBy } from './address.js';
import { Answer } from './answer.js';
import { choiceOf, heightsOf, linesOf, stepTo } from './maps.js';
import { Places } from './places.js';
import { queryOf } from './question.js';
import { Route } from './route.js';
import { attempt, element, LastQuestion, request } from './show.js';
import { tilesOf } from './tiles.js';
import { Tracks } from './tracks.js';

const by = (id) => document.getElementById(id);
const view = L.map('map', { preferCanvas: true, zoomSnap: 0.5 }).setView([0, 0], 2);
L.control.scale({ imperial: false }).addTo(view);
view.attributionControl.setPrefix('<a href="/console/leaflet-licence.txt">Leaflet</a>');
const answer = new Answer(view, by('answer'));
const places = new Places(view, by('place'), by('footprint'), by('layer'));
const route = new Route(view, by('along'));
const MAPS_REFRESH_MS = 10_000;
const PATIENCE_MS = 5000;
const TILES_AT_A_TIME = 2;
const mapQuestions = new LastQuestion();
let shown = null;  // the map on the page, see maps.js
let listed = [];   // the maps as the service had them last
let lines = '';    // of their list on the page, as JSON
let tiles = null;
let listsAsked = 0;
let wished = null;  // the map that the next list is to show, if it is served
const circle = L.circle([0, 0], { radius: 0, color: '#8ab4f8', weight: 2, dashArray: '2 6', fill: false, interactive: false });
const tracks = new Tracks(view, by('tracks'), by('track'), by('details'), { shown: () => shown, wish: wishMap });

const mapUrl = () => `/v1/maps/${encodeURIComponent(by('maps').value)}`;

async function drawLayer() {
  if (tiles) await places.drawLayer(mapUrl(), shown.version, tiles.options.maxZoom);
}

/// Draws the chosen map as it is now; gives what the service says of it.
async function drawMap() {
  const url = mapUrl();
  const signal = mapQuestions.next(PATIENCE_MS);
  const [info, tileset] = await Promise.all([request(url, { signal }), request(`${url}/tilejson.json`, { signal })]);
  if (tiles) tiles.remove();
  tiles = tilesOf(`${url}/tiles/{z}/{x}/{y}.png?version=${info.version}`, {
    maxNativeZoom: tileset.maxzoom, maxZoom: tileset.maxzoom + 2, attribution: element('span', tileset.attribution).innerHTML,
  }, TILES_AT_A_TIME).addTo(view);
  shown = { name: info.name, version: info.version, bbox: info.bbox, heights: heightsOf(info) };
  by('about').replaceChildren(
    element('div', `${info.area_km2.toFixed(1)} km² in cells of ${info.cell_m} m, EPSG:${info.epsg}`),
    element('div', shown.heights),
    ...info.sources.map((s) => element('div', [s.name, s.kind, s.date, s.licence].filter(Boolean).join(' · '))));
  return info;
}

/// What was of the map before leaves at once: its roads under the name of another map would be read as that one's.
async function openMap() {
  answer.forget();
  places.forget();
  places.removeLayer();
  forgetRoute();
  if (tiles) tiles.remove();
  tiles = null;
  by('about').textContent = 'opening …';
  shown = { name: by('maps').value, version: null };
  try {
    const info = await drawMap();
    const [west, south, east, north] = info.bbox;
    view.fitBounds([[south, west], [north, east]]);
  } catch (error) {
    if (error.name !== 'AbortError') shown = null;  // so that the next look at the list tries again
    throw error;
  }
  await drawLayer();
}

/// Keeps the list as the service has it and the choice as the operator left it.
async function showMaps({ maps }) {
  listed = maps;
  const chosen = choiceOf(maps, by('maps').value, wished);
  const missed = wished === chosen ? null : wished;
  wished = null;
  const wanted = linesOf(maps, chosen);
  if (lines !== JSON.stringify(wanted)) {
    lines = JSON.stringify(wanted);
    by('maps').replaceChildren(...wanted.map(({ name, text, disabled }) => {
      const option = new Option(text, name);
      option.disabled = disabled;
      return option;
    }));
  }
  by('maps').value = chosen;
  if (chosen === null) by('about').textContent = 'No map is in the folder yet: roadfix ingest makes one.';
  by('ask').querySelector('button').disabled = chosen === null;
  enableChosen(by('ask'));
  answer.mapsChanged(maps);
  const step = stepTo(maps, chosen, shown);
  if (step === 'open') await openMap();
  if (step === 'redraw') {
    places.forget();
    await drawMap();
    askRoute();
    await drawLayer();
  }
  if (missed) by('about').prepend(element('div', `there is no map ${missed} to show`, 'why'));
}

/// A service that does not answer now is said to be so, and asked again.
async function refreshMaps() {
  if (document.hidden) return;
  listsAsked += 1;
  const asked = listsAsked;
  const list = await request('/v1/maps', { signal: AbortSignal.timeout(PATIENCE_MS) }).catch(() => null);
  if (asked !== listsAsked) return;
  const trouble = list ? '' : 'The service gives no answer. This page shows what it said before.';
  if (by('trouble').textContent !== trouble) by('trouble').textContent = trouble;  // said aloud, so only when it changes
  if (list) await attempt(by('about'), () => showMaps(list));
}

function wishMap(name) {
  if (name === by('maps').value) return;
  wished = name;
  refreshMaps();
}

/// Only numbers of the chosen kind of picture, place and map count: a mistake in one that is not shown must not hold up
/// others.
function enableChosen(form) {
  const { what, prior } = form.elements;
  const knowsHeights = listed.some(({ name, terrain }) => name === by('maps').value && terrain);
  const counts = [`of-${what.value}`, `of-${prior.value}`, knowsHeights && 'of-heights'];
  for (const input of form.querySelectorAll('[class^=of-] input')) {
    input.disabled = !input.parentElement.className.split(' ').every((name) => counts.includes(name));
  }
}

function openAddress() {
  const { map, track } = shownBy(location.hash);
  if (map) wishMap(map);
  tracks.follow(track ?? '');
}

/// Names in the address what the page shows, so that loading it again shows the same.
function keepAddress() {
  history.replaceState(null, '', hashOf({ map: by('maps').value, track: by('tracks').value }));
}

function follow(id) {
  tracks.follow(id);
  keepAddress();
}

/// The circle that a search of "around the middle of the view" is about.
function drawPrior() {
  const { prior, radius_m: radius } = by('ask').elements;
  circle.remove();
  if (prior.value === 'circle') circle.setLatLng(view.getCenter()).setRadius(Number(radius.value)).addTo(view);
}

function askPlace(latlng) {
  if (tiles) places.ask(mapUrl(), latlng);
}

function askRoute() {
  const [file] = by('route').files ?? [];
  const fov = by('fov').value;
  const frames = fov ? { fov_deg: fov } : { footprint_m: Number(by('footprint').value) };
  if (tiles && file) route.ask(mapUrl(), file, frames);
}

function forgetRoute() {
  route.forget();
  by('route').value = '';
}

const isRoute = (name) => /\.(plan|waypoints|txt|json|geojson)$/i.test(name);

/// Wherever on the page: a browser would leave it to show what was dropped beside its place.
function acceptDrops(zone, inputFor) {
  for (const name of ['dragover', 'dragleave', 'drop']) {
    document.addEventListener(name, (event) => {
      event.preventDefault();
      zone.classList.toggle('over', name === 'dragover');
      if (name !== 'drop' || !event.dataTransfer.files.length) return;
      const first = new DataTransfer();  // of several, so that its name stands in the field
      first.items.add(event.dataTransfer.files[0]);
      const input = inputFor(first.files[0].name);
      input.files = first.files;
      input.dispatchEvent(new Event('input', { bubbles: true }));
    });
  }
}

by('maps').addEventListener('change', () => {
  wished = null;
  keepAddress();
  enableChosen(by('ask'));
  attempt(by('about'), openMap);
});
by('tracks').addEventListener('change', () => follow(by('tracks').value));
by('ask').addEventListener('submit', (event) => {
  event.preventDefault();
  const form = new FormData(event.target);
  answer.ask(`${mapUrl()}/fix?${queryOf(form, view.getCenter())}`, form.get('picture'));
});
by('ask').addEventListener('input', () => {
  enableChosen(by('ask'));
  drawPrior();
  answer.questionChanged();
});
view.on('move', drawPrior);
enableChosen(by('ask'));
view.on('click', ({ latlng }) => askPlace(latlng));
view.on('keypress', ({ originalEvent }) => {
  if (originalEvent.key === 'Enter') askPlace(view.getCenter());
});
for (const id of ['layer', 'footprint']) by(id).addEventListener('change', drawLayer);
by('footprint').addEventListener('input', () => places.forget());
for (const id of ['footprint', 'fov']) by(id).addEventListener('change', askRoute);
// A browser says "cancel" where the same file is chosen again, also one that was changed since.
for (const name of ['input', 'cancel']) by('route').addEventListener(name, askRoute);
acceptDrops(by('drop'), (name) => (isRoute(name) ? by('route') : by('ask').elements.picture));
by('follow').addEventListener('submit', (event) => {
  event.preventDefault();
  follow(event.target.elements.track.value.trim());
});
openAddress();
refreshMaps();
setInterval(refreshMaps, MAPS_REFRESH_MS);
document.addEventListener('visibilitychange', refreshMaps);
window.addEventListener('focus', refreshMaps);
window.addEventListener('hashchange', openAddress);
