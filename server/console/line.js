// The line of the places that a track was sure of; where it was not, there is a gap.
import { towards } from './geometry.js';
import { inView } from './show.js';

export class Line {
  #lines = [[]];
  #drawn = null;
  #newest = null;
  /// The step up to which it is known.
  after = -1;

  /// Drawn as `figure`.
  constructor(view, figure) {
    Object.assign(this, { view, figure });
  }

  /// `features` of the history of the track.
  add(features) {
    for (const { geometry, properties } of features) {
      if (properties.sequence === undefined) continue;  // the line of all
      this.after = properties.sequence;
      if (geometry) this.#add(geometry.coordinates);
      else if (this.#lines.at(-1).length) this.#lines.push([]);
    }
    this.#drawn = null;
  }

  /// Beside the place before it, also across the 180th meridian.
  #add([lon, lat]) {
    this.#newest = [lat, this.#newest ? towards(lon, this.#newest[1]) : lon];
    this.#lines.at(-1).push(this.#newest);
  }

  /// On the side of the 180th meridian that is shown now.
  draw() {
    if (!this.#newest) return;
    const [lat, lon] = this.#newest;
    const shift = inView(this.view, { lat, lon })[1] - lon;
    if (this.#drawn === shift) return;
    this.#drawn = shift;
    this.figure.setLatLngs(this.#lines.map((line) => line.map(([north, east]) => [north, east + shift])));
  }
}
