// Whether a frame of a place would give a fix: of the place that is clicked, and of all places of the view as a layer.
import { square } from './geometry.js';
import { attempt, COLOURS, drawModes, LastQuestion, request, reveal, showStatus } from './show.js';
import { tilesOf } from './tiles.js';

const TILES_AT_A_TIME = 2;

export class Places {
  #questions = new LastQuestion();
  #layerQuestions = new LastQuestion();
  #layer = null;

  /// `footprint` and `wanted` are the inputs of the footprint's side and of the layer.
  constructor(view, output, footprint, wanted) {
    Object.assign(this, { view, output, footprint, wanted });
    this.figures = L.layerGroup().addTo(view);
  }

  async ask(mapUrl, latlng) {
    const side = Number(this.footprint.value);
    const at = latlng.wrap();
    this.forget();
    const signal = this.#questions.next();
    const frame = L.polygon(square([latlng.lat, latlng.lng], side), { color: '#8ab4f8', weight: 2, fill: false }).addTo(this.figures);
    showStatus(this.output, 'looking …', []);
    await attempt(this.output, async () => {
      const query = new URLSearchParams({ lat: at.lat, lon: at.lng, footprint_m: side });
      const place = await request(`${mapUrl}/localizability?${query}`, { signal });
      showStatus(this.output, place.status, [
        place.explanation,
        `probability ${place.probability.toFixed(3)}, ${(100 * place.road_share).toFixed(0)} % road, ${(100 * place.observed_share).toFixed(0)} % of the ground is on the map`]);
      frame.setStyle({ color: COLOURS[place.status] });
      if (place.alike) drawModes(this.view, this.figures, place.alike, 'ambiguous');
    });
    if (!signal.aborted) reveal(this.output);
  }

  /// Of the place that was clicked; the layer stays.
  forget() {
    this.#questions.next();
    this.figures.clearLayers();
    this.output.replaceChildren();
  }

  removeLayer() {
    this.#layerQuestions.next();
    this.#layer?.remove();
    this.#layer = null;
  }

  /// Draws the layer anew, where it is wanted, and says what is wrong with it.
  async drawLayer(mapUrl, version, maxZoom) {
    this.removeLayer();
    if (!this.wanted.checked) return;
    const signal = this.#layerQuestions.next();
    await attempt(this.output, async () => {
      const query = `footprint_m=${Number(this.footprint.value)}`;
      const tileset = await request(`${mapUrl}/localizability/tilejson.json?${query}`, { signal });
      const [west, south, east, north] = tileset.bounds;
      this.#layer = tilesOf(`${mapUrl}/localizability/tiles/{z}/{x}/{y}.png?${query}&version=${version}`, {
        minZoom: tileset.minzoom, maxNativeZoom: tileset.maxzoom, maxZoom,
        bounds: east - west === 360 ? null : [[south, west], [north, east]],  // Leaflet would leave out what lies beyond the 180th meridian
      }, TILES_AT_A_TIME).addTo(this.view);
      if (this.view.getZoom() < tileset.minzoom) this.view.setZoom(tileset.minzoom);
    });
  }
}
