// Answers of the service as text in the panel and as figures on the map.
import { arrow, ellipse95, towards } from './geometry.js';

export const COLOURS = { fix: '#7ee0a1', ambiguous: '#f4c95d', no_fix: '#f28b82' };

/// Without its status: a proxy that knows of no page says nothing of what the service knows of.
function problemOfProxy({ status }) {
  const detail = status === 413 ? 'it lets no picture of this size through: send a smaller one' : 'the service behind it may be away: try again';
  return { title: `A proxy before the service answered ${status}`, detail };
}

/// The JSON of an answer, never one that a cache kept; throws the problem (RFC 9457) of any other.
export async function request(url, options, send = fetch) {
  const answer = await send(url, { cache: 'no-cache', ...options });
  const body = await answer.json().catch((error) => {
    throw error instanceof SyntaxError ? problemOfProxy(answer) : error;
  });
  if (!answer.ok) throw body;
  return body;
}

/// Of the questions to one part of the page the last one counts: an answer to an earlier one would be about another
/// picture, place or map than the page shows by then.
export class LastQuestion {
  #last = new AbortController();

  /// For request(); ends what is asked with the signals before it, and where a patience is told, itself after that.
  next(patienceMs) {
    this.#last.abort();
    const asked = new AbortController();
    this.#last = asked;
    if (patienceMs) setTimeout(() => asked.abort(new DOMException('no answer came in time', 'TimeoutError')), patienceMs);
    return asked.signal;
  }
}

/// An element with text, never HTML: names of maps and messages come from outside.
export function element(name, text = '', className = '') {
  const made = document.createElement(name);
  made.textContent = text;
  if (className) made.className = className;
  return made;
}

export function table(rows) {
  const made = element('table');
  for (const [name, value] of rows) {
    const row = made.insertRow();
    row.insertCell().append(element('span', name, 'faint'));
    row.insertCell().append(value);
  }
  return made;
}

const degrees = (value, digits) => `${value.toFixed(digits)}°`;
const place = (pose) => `${pose.lat.toFixed(6)}, ${pose.lon.toFixed(6)}`;

/// Where to draw a place, on the side of the 180th meridian that is shown.
export function inView(view, { lat, lon }) {
  return [lat, towards(lon, view.getCenter().lng)];
}

/// At once: what is drawn while a view flies is beside its place until the view has come to rest.
export function moveTo(view, pose, zoom) {
  view.setView(inView(view, pose), Math.max(view.getZoom(), zoom), { animate: false });
}

/// No direction of a camera is known to less than a tenth of a degree, however sharp the match.
export function headingText(pose, sigma) {
  return `${degrees(pose.heading_deg, 1)} ± ${degrees(Math.max(0.1, sigma), 1)}`;
}

function modeText(mode) {
  const [long, short] = mode.sigma_m;
  return `${place(mode.pose)}, heading ${degrees(mode.pose.heading_deg, 1)}, σ ${long.toFixed(1)} × ${short.toFixed(1)} m, weight ${mode.weight.toFixed(3)}`;
}

/// `look` is a class of console.css, `word` what is read.
export function showStatus(output, look, lines, word = look) {
  output.classList.remove('old');
  output.ariaBusy = null;
  output.replaceChildren(element('span', word.replaceAll('_', ' '), `status ${look}`));
  for (const line of lines.filter(Boolean)) output.append(element('div', line));
}

/// Says above an answer why it is one no longer, if `why` is not empty; what is left of it looks like no answer.
export function showOld(output, why) {
  output.classList.toggle('old', Boolean(why));
  output.querySelector('.why')?.remove();
  if (why) output.prepend(element('div', `${why}: this is how it was`, 'why'));
}

export function showProblem(output, problem) {
  showStatus(output, 'failed', [problem.title, problem.detail]);
}

/// Runs `work`; what goes wrong is said in `output`, but nothing of what was given up for a newer question.
export async function attempt(output, work) {
  try {
    await work();
  } catch (error) {
    if (error.name === 'AbortError') return;
    showProblem(output, error.title ? error : { title: 'The service gives no answer', detail: String(error.message ?? error) });
  }
}

/// Modes of a no_fix are drawn faint: they are hints, not answers. Of a fix the first one is the answer, the others are
/// its rivals. What weighs next to nothing is left out.
export function drawModes(view, layer, modes, status) {
  for (const mode of modes.filter((m) => m.weight >= 0.01 * modes[0].weight)) {
    const answer = status === 'fix' && mode === modes[0];
    const colour = COLOURS[status === 'fix' && !answer ? 'ambiguous' : status];
    const at = inView(view, mode.pose);
    const opacity = status === 'no_fix' ? 0.35 : 0.4 + 0.6 * Math.min(1, mode.weight);
    const style = { color: colour, opacity, fillOpacity: 0.15 * opacity, weight: 2, dashArray: answer ? null : '4 4' };
    L.polygon(ellipse95(at, mode.sigma_m, mode.ellipse_heading_deg), style).addTo(layer);
    L.polyline(arrow(at, mode.pose.heading_deg, 60), style).addTo(layer);
    L.circleMarker(at, { ...style, radius: 5 }).bindTooltip(modeText(mode)).addTo(layer);
  }
}

/// What a photo told of its camera, for the operator to see that it is so.
function cameraRows({ camera }) {
  if (!camera) return [];
  const tilt = `roll ${degrees(camera.roll_deg, 1)}, pitch ${degrees(camera.pitch_deg, 1)}`;
  return [['camera', `${camera.agl_m.toFixed(0)} m above ground, ${tilt}, focal length ${camera.focal_px.toFixed(0)} px`]];
}

/// With its day, since a page stays open overnight, and its zone: logs and people elsewhere say UTC.
const timeText = (date) => date.toLocaleString([], { dateStyle: 'medium', timeStyle: 'long' });

function timeNeeded({ detect, search }) {
  const parts = [[detect, 'to detect'], [search, 'to search']].filter(([time]) => time !== undefined);  // a feature map is detected already
  return parts.map(([time, what]) => `${Math.round(time)} ms ${what}`).join(', ');
}

/// Into sight: below a long form it would be missed.
export function reveal(output) {
  output.scrollIntoView({ block: 'nearest' });
}

export function showFix(output, fix, picture) {
  showStatus(output, fix.status, [fix.explanation ?? fix.reason]);
  const rows = [['picture', picture], ...cameraRows(fix), ['answered', timeText(new Date())], ['probability', fix.probability.toFixed(4)]];
  if (fix.pose) {
    rows.push(['lat, lon', place(fix.pose)], ['heading, true', headingText(fix.pose, fix.heading_sigma_deg)]);
    rows.push(['σ', fix.sigma_m.map((s) => s.toFixed(1)).join(' × ') + ' m; drawn: 95 %']);
    if (fix.agl_m) rows.push(['above ground', `${fix.agl_m.toFixed(0)} m, by the height above the sea`]);
  } else if (fix.modes.length) {
    rows.push(['hints', `${fix.modes.length}, not to be flown on`]);
  }
  rows.push(['searched', `${fix.searched.area_km2.toFixed(1)} km², ${fix.searched.headings} headings`]);
  rows.push(['time', timeNeeded(fix.time_ms)]);
  output.append(table(rows));
}
