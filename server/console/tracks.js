// Tracks as they fly: a line of the places they were sure of, the last estimate with its ellipse, and how old it is.
// What cannot be kept up to date is drawn faint and said to be old.
import { drawModes, inView, request, showStatus, table } from './show.js';

const REFRESH_MS = 5000;
const STATUS = { converged: 'fix', searching: 'ambiguous' };

export class Tracks {
  constructor(view, list, output) {
    this.view = view;
    this.list = list;
    this.output = output;
    this.path = L.polyline([], { color: '#8ab4f8', weight: 2 }).addTo(view);
    this.estimate = L.layerGroup().addTo(view);
    this.events = null;
    list.addEventListener('change', () => this.follow(list.value));
    this.refresh();
    setInterval(() => this.refresh(), REFRESH_MS);
  }

  /// Keeps the list as the service has it; a service that does not answer now is asked again.
  async refresh() {
    const answer = await request('/v1/tracks').catch(() => null);
    if (!answer) return;
    const { tracks } = answer;
    const known = new Set([...this.list.options].map((option) => option.value));
    for (const { id, map, stale } of tracks) {
      if (!known.delete(id)) this.list.add(new Option(`${map.name}, ${id.slice(0, 8)}`, id));
      if (id === this.list.value) this.output.classList.toggle('stale', stale);
    }
    known.delete('');
    for (const option of [...this.list.options]) if (known.has(option.value) && !option.selected) option.remove();
  }

  follow(id) {
    this.events?.close();
    this.last = null;
    this.path.setLatLngs([]);
    this.estimate.clearLayers();
    this.output.replaceChildren();
    this.output.classList.remove('cut-off', 'ended', 'stale');
    if (!id) return;
    this.events = new EventSource(`/v1/tracks/${encodeURIComponent(id)}/events`);
    this.events.addEventListener('step', (event) => this.show(JSON.parse(event.data)));
    this.events.addEventListener('open', () => this.setConnected(true));
    this.events.addEventListener('error', () => this.setConnected(false));
    this.events.addEventListener('end', () => {
      this.events.close();
      this.output.classList.add('ended');
      if (this.last) this.draw(this.last);
    });
  }

  /// A browser reconnects by itself, and the service then sends the steps that were missed.
  setConnected(connected) {
    this.output.classList.toggle('cut-off', !connected);
    if (this.last) this.draw(this.last);
  }

  show(step) {
    this.last = step;
    const status = STATUS[step.status] ?? 'no_fix';
    showStatus(this.output, status, [], step.status);
    this.output.append(table([
      ['step', String(step.sequence)],
      ['measurement', step.measurement],
      ['last accepted', step.since_accepted_s === null ? 'never' : `${step.since_accepted_s.toFixed(1)} s before`],
      ['within, 95 %', step.pose ? `${step.radius95_m.toFixed(1)} m` : 'not sure of a place'],
      ['places', String(step.cluster_count)],
      ['resets', String(step.resets)],
      ['odometry', step.drifts ? 'drifts: tell its covariance, or a wind' : 'as it says'],
    ]));
    if (step.pose) this.path.addLatLng(inView(this.view, step.pose));
    this.draw(step);
  }

  draw(step) {
    const old = ['cut-off', 'ended'].some((name) => this.output.classList.contains(name));
    this.estimate.clearLayers();
    drawModes(this.view, this.estimate, step.clusters, old ? 'no_fix' : STATUS[step.status] ?? 'no_fix');
  }
}
