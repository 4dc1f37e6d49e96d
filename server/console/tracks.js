// A track as the service has it now: a line of the places it was sure of, its last estimate with its ellipse, and how old
// that is. It is asked for again and again and not read from the stream of events, in which a connection that hangs looks
// like a vehicle that is silent, and steps that waited on a slow one look like news.
import { Line } from './line.js';
import { drawModes, element, headingText, inView, moveTo, request, showOld, showProblem, showStatus, table } from './show.js';

const LIST_MS = 5000;
const LOOK_MS = 1000;
const PATIENCE_MS = 5000;
/// An estimate tells where the vehicle was. Older ones are not drawn as where it is.
const FRESH_S = 10;
/// Places of the line that are loaded at a time, and for how long: over a slow link these hundreds of kB take longer.
const LINE_STEPS = 500;
const LINE_PATIENCE_MS = 60_000;
const STATUS = { converged: 'fix', searching: 'ambiguous' };

const get = (url, patienceMs = PATIENCE_MS) => request(url, { signal: AbortSignal.timeout(patienceMs) });
const urlOf = (id) => `/v1/tracks/${encodeURIComponent(id)}`;

function textOf({ id, map, created_us, stale }) {
  const began = new Date(created_us / 1000);
  const day = began.toDateString() === new Date(Date.now()).toDateString() ? {} : { day: 'numeric', month: 'short' };
  const since = began.toLocaleString([], { ...day, hour: '2-digit', minute: '2-digit' });
  return `${map.name}, ${id.slice(0, 8)}, since ${since}${stale ? ', silent' : ''}`;
}

/// What is wrong with the map on the page (see maps.js) as the ground of a track; empty if nothing is.
function whyElsewhere({ map }, shown) {
  if (!shown?.version) return '';
  if (shown.name !== map.name) return `drawn on another map: it flies over ${map.name}`;
  return shown.version === map.version ? '' : 'its map was replaced since it began';
}

export class Tracks {
  /// `maps`: shown() is the map on the page, wish() asks for another one.
  constructor(view, list, output, details, maps) {
    this.maps = maps;
    this.view = view;
    this.list = list;
    this.output = output;
    this.details = details;
    this.path = L.polyline([], { color: '#8ab4f8', weight: 2 }).addTo(view);
    this.estimate = L.layerGroup().addTo(view);
    this.chosen = null;
    this.refresh();
    setInterval(() => this.refresh(), LIST_MS);
    setInterval(() => this.look(), LOOK_MS);
    document.addEventListener('visibilitychange', () => this.look());
  }

  /// Keeps the list as the service has it; a service that does not answer now is asked again.
  async refresh() {
    const answer = await get('/v1/tracks').catch(() => null);
    if (!answer) return;
    for (const track of answer.tracks) this.keepLine(track.id, textOf(track));
    const listed = new Set(['', ...answer.tracks.map(({ id }) => id)]);
    for (const option of [...this.list.options]) if (!option.selected && !listed.has(option.value)) option.remove();
  }

  lineOf(id) {
    return [...this.list.options].find(({ value }) => value === id);
  }

  keepLine(id, text) {
    const option = this.lineOf(id);
    if (!option) this.list.add(new Option(text, id));
    else if (option.text !== text) option.text = text;
  }

  /// Also one that is not in the list, as it was begun from another address.
  follow(id) {
    if (id && !this.lineOf(id)) this.keepLine(id, id.slice(0, 8));
    this.list.value = id;
    this.path.setLatLngs([]);
    this.estimate.clearLayers();
    for (const part of [this.output, this.details]) {
      part.replaceChildren();
      part.classList.remove('old');
    }
    this.chosen = id ? { id, line: new Line(this.view, this.path) } : null;
    return this.look();
  }

  /// Asks for the chosen track, unless that is under way, and shows what is known of it by then.
  async look() {
    const { chosen } = this;
    if (!chosen) return;
    this.show(chosen);
    if (chosen.asking || chosen.ended) return;
    chosen.asking = true;
    const asked = Date.now();
    try {
      const track = await get(urlOf(chosen.id));
      if (chosen === this.chosen) {
        this.keepLine(chosen.id, textOf(track));
        if (!chosen.track) this.maps.wish(track.map.name);
      }
      Object.assign(chosen, { track, heard: asked - 1000 * (track.last_age_s ?? track.silent_s), trouble: null });
    } catch (error) {
      chosen.ended = error.status === 404 || error.status === 410;
      chosen.trouble = error.title ? error : { title: 'The service gives no answer' };
    }
    chosen.asking = false;
    if (chosen !== this.chosen) return;
    this.show(chosen);
    if (!chosen.trouble) await this.extend(chosen);
  }

  /// Why the last step of a track is no longer how it is; empty while it is.
  whyOld({ track, trouble, ended, heard }) {
    if (ended) return 'the track has ended';
    if (trouble) return trouble.title;
    if (track.last_age_s === undefined) return 'the service was started anew, and no step has come since';
    return Date.now() - heard < 1000 * FRESH_S ? '' : `the last step is older than ${FRESH_S} s`;
  }

  show(chosen) {
    if (!chosen.track && !chosen.trouble) return;
    const step = chosen.track?.last;
    const elsewhere = chosen.track ? whyElsewhere(chosen.track, this.maps.shown()) : '';
    if (step) this.showStep(chosen, step, elsewhere);
    else this.showNoStep(chosen, elsewhere);
  }

  showNoStep(chosen, elsewhere) {
    const { trouble } = chosen;
    const state = JSON.stringify([trouble?.title, trouble?.detail, elsewhere]);  // said aloud, so only when it changes
    if (chosen.state === state) return;
    chosen.state = state;
    if (trouble) showProblem(this.output, trouble);
    else showStatus(this.output, 'waiting', ['no step has come yet', elsewhere]);
  }

  showStep(chosen, step, elsewhere) {
    const old = this.whyOld(chosen);
    const [first] = step.clusters;
    const side = first && inView(this.view, first.pose)[1];  // of the 180th meridian
    const drawn = JSON.stringify([step.sequence, old, elsewhere, side]);
    if (chosen.drawn !== drawn) this.draw(chosen, step, old, elsewhere);
    chosen.drawn = drawn;
    chosen.age.textContent = `${Math.max(0, (Date.now() - chosen.heard) / 1000).toFixed(0)} s ago`;
    chosen.line.draw();
  }

  draw(chosen, step, old, elsewhere) {
    const look = STATUS[step.status] ?? 'no_fix';
    const state = JSON.stringify([step.status, old, elsewhere]);  // said aloud, so only when it changes
    if (chosen.state !== state) {
      showStatus(this.output, look, [], step.status);
      if (elsewhere) this.output.append(element('div', elsewhere, 'elsewhere'));
      showOld(this.output, old);
    }
    chosen.state = state;
    chosen.age = element('span');
    this.details.classList.toggle('old', Boolean(old));
    this.details.replaceChildren(table([
      ['last step', chosen.age],
      ...(step.pose ? [
        ['lat, lon', `${step.pose.lat.toFixed(6)}, ${step.pose.lon.toFixed(6)}`],
        ['heading, true', headingText(step.pose, step.heading_sigma_deg)],
      ] : []),
      step.pose ? ['within, 95 %', `${step.radius95_m.toFixed(1)} m`] : ['no place', step.explanation],
      ['map', chosen.track.map.name],
      ['step', String(step.sequence)],
      ['measurement', step.measurement],
      ['last accepted', step.since_accepted_s === null ? 'never' : `${step.since_accepted_s.toFixed(1)} s before`],
      ['places', String(step.cluster_count)],
      ['resets', String(step.resets)],
      ['odometry', step.drifts ? 'drifts: tell its covariance, or a wind' : 'as it says'],
    ]));
    this.estimate.clearLayers();
    drawModes(this.view, this.estimate, step.clusters, old ? 'no_fix' : look);
    if (step.clusters.length && !chosen.seen) {
      chosen.seen = true;
      const { pose } = step.clusters[0];
      if (!this.view.getBounds().contains(inView(this.view, pose))) moveTo(this.view, pose, 14);
    }
  }

  /// Draws on the line what the track was sure of since.
  async extend(chosen) {
    const { id, line, track } = chosen;
    if (chosen.extending || (track.last?.sequence ?? -1) <= line.after) return;
    chosen.extending = true;
    const url = `${urlOf(id)}/history?after=${line.after}&limit=${LINE_STEPS}`;
    const answer = await get(url, LINE_PATIENCE_MS).catch(() => null);
    chosen.extending = false;
    line.add(answer?.features ?? []);
    if (chosen === this.chosen) line.draw();
  }
}
