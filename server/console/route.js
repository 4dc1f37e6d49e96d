// Where along a planned route frames would give a fix: drawn piece by piece, as the service finds it out.
import { attempt, COLOURS, inView, LastQuestion, moveTo, request, reveal, showStatus } from './show.js';
import { bytesOf } from './upload.js';

const PIECES_AT_A_TIME = 8;
/// A line has no word beside it: its red is much darker than its green, for those who do not tell the two by their hue.
const DARK_RED = '#d93025';
export const LOOKS = {
  distinct: { color: COLOURS.fix, means: 'a frame gives a fix' },
  sparse: { color: COLOURS.ambiguous, means: 'its roads fit elsewhere, too, or are too few' },
  bare: { color: DARK_RED, means: 'hardly any road' },
  unknown: { color: '#9aa0a6', means: 'not on the map' },
};
const km = (metres) => (metres / 1000).toFixed(1);

/// The most pieces in a row without a fix, as [from, to] in metres; null where there is none.
export function longestWithout(pieces) {
  let longest = null;
  let from = null;
  for (const { from_m, to_m, place } of pieces) {
    if (place === 'distinct') {
      from = null;
      continue;
    }
    from ??= from_m;
    if (!longest || to_m - from > longest[1] - longest[0]) longest = [from, to_m];
  }
  return longest;
}

/// How high the pieces are, and how much frames show from there; none where their heights were not asked for.
function heightsOf(pieces) {
  const range = (name) => {
    const values = pieces.map((piece) => piece[name]).filter((value) => value !== undefined);
    return values.length ? `${Math.min(...values).toFixed(0)} to ${Math.max(...values).toFixed(0)} m` : null;
  };
  const agl = range('agl_m');
  return agl ? [`${agl} above ground, of which frames show ${range('footprint_m')}`] : [];
}

/// What is known of the pieces so far.
export function linesAbout(pieces, length, leftOut) {
  const asked = pieces.length ? pieces.at(-1).to_m : 0;
  const share = (kind) => pieces.filter(({ place }) => place === kind).length / pieces.length;
  const gap = longestWithout(pieces);
  return [
    asked < 0.999 * length ? `${km(asked)} of ${km(length)} km are looked at` : `${km(length)} km`,
    ...heightsOf(pieces),
    ...Object.keys(LOOKS).filter((kind) => share(kind) > 0).map((kind) => `${(100 * share(kind)).toFixed(0)} % ${kind}: ${LOOKS[kind].means}`),
    gap ? `longest without a fix: ${km(gap[1] - gap[0])} km, from km ${km(gap[0])} to ${km(gap[1])}` : 'a fix all along',
    ...leftOut.map((part) => `left out: ${part}`),
  ];
}

export class Route {
  #questions = new LastQuestion();

  constructor(view, output) {
    Object.assign(this, { view, output });
    this.figures = L.layerGroup().addTo(view);
  }

  /// `frames`: { footprint_m } that they show everywhere, or { fov_deg } of their camera.
  async ask(mapUrl, file, frames) {
    this.forget();
    const signal = this.#questions.next();
    showStatus(this.output, 'waiting', [], 'looking …');
    await attempt(this.output, async () => {
      const body = await bytesOf(file, signal);
      const pieces = [];
      for (let answer = { complete: false, next_m: 0 }; !answer.complete;) {
        const query = new URLSearchParams({ ...frames, limit: PIECES_AT_A_TIME, from_m: answer.next_m });
        answer = await request(`${mapUrl}/localizability?${query}`, { method: 'POST', body, headers: { 'Content-Type': 'application/octet-stream' }, signal });
        if (!answer.features.length) throw { title: 'The service is too busy to go on', detail: 'choose the route again later' };
        if (!pieces.length) this.#show(answer.features[0]);
        for (const piece of answer.features) this.#draw(piece);
        pieces.push(...answer.features.map(({ properties }) => properties));
        const lines = linesAbout(pieces, answer.length_m, answer.left_out);
        showStatus(this.output, 'waiting', [file.name, ...lines], answer.complete ? 'route' : 'looking …');
      }
    });
    if (!signal.aborted) reveal(this.output);
  }

  forget() {
    this.#questions.next();
    this.figures.clearLayers();
    this.output.replaceChildren();
  }

  #parts({ type, coordinates }) {
    const parts = type === 'LineString' ? [coordinates] : coordinates;
    return parts.map((part) => part.map(([lon, lat]) => inView(this.view, { lat, lon })));
  }

  #show({ geometry }) {
    const [[[lat, lon]]] = this.#parts(geometry);
    if (!this.view.getBounds().contains([lat, lon])) moveTo(this.view, { lat, lon }, 13);
  }

  #draw({ geometry, properties: { from_m, to_m, place, probability, agl_m } }) {
    const height = agl_m === undefined ? '' : `, ${agl_m.toFixed(0)} m above ground`;
    const text = `km ${km(from_m)} to ${km(to_m)}: ${place}, probability ${probability.toFixed(3)}${height}`;
    for (const part of this.#parts(geometry)) {
      L.polyline(part, { color: LOOKS[place].color, weight: 5, opacity: 0.8 }).bindTooltip(text).addTo(this.figures);
    }
  }
}
