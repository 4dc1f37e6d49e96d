// The answer to the question where a picture was taken. It stands only for the picture, the numbers and the map that it
// was asked with: when one of them is another, it stays to be read, as an old one.
import { attempt, drawModes, LastQuestion, moveTo, request, reveal, showFix, showOld, showStatus } from './show.js';
import { bytesOf, upload } from './upload.js';

/// How far the question is.
function showSent(output, sent, size) {
  if (sent < size) showStatus(output, 'sending …', [`${Math.round(sent / 1000)} of ${Math.round(size / 1000)} kB are sent`]);
  else showStatus(output, 'searching …', []);
  if (sent > 0 && sent < size) output.ariaBusy = 'true';  // or screen readers read each of these amounts aloud
}

export class Answer {
  #questions = new LastQuestion();
  #fix = null;
  #old = '';

  constructor(view, output) {
    this.view = view;
    this.output = output;
    this.figures = L.layerGroup().addTo(view);
  }

  async ask(url, picture) {
    this.forget();
    const signal = this.#questions.next();
    showStatus(this.output, 'reading the picture …', []);
    await attempt(this.output, async () => {
      const body = await bytesOf(picture, signal);
      const progress = (sent) => showSent(this.output, sent, body.byteLength);
      progress(0);
      this.#fix = await request(url, { method: 'POST', body, headers: { 'Content-Type': picture.type }, signal, progress }, upload);
      showFix(this.output, this.#fix, picture.name);
      this.#draw(this.#fix.status);
      const { pose } = this.#fix;
      if (pose) moveTo(this.view, pose, 16);
    });
    if (!signal.aborted) reveal(this.output);
  }

  forget() {
    this.#questions.next();
    this.#fix = null;
    this.#old = '';
    this.figures.clearLayers();
    this.output.replaceChildren();
  }

  /// For another question on the page than the one that was asked.
  questionChanged() {
    if (this.#fix) this.#outdate('the question has changed');
    else this.forget();
  }

  /// `maps` as the service has them now.
  mapsChanged(maps) {
    const { map } = this.#fix ?? {};
    if (map && !maps.some(({ name, version }) => name === map.name && version === map.version)) this.#outdate('its map has changed');
  }

  #outdate(why) {
    if (this.#old === why) return;  // said aloud, so only when it changes
    this.#old = why;
    showOld(this.output, why);
    this.#draw('no_fix');
  }

  #draw(look) {
    this.figures.clearLayers();
    drawModes(this.view, this.figures, this.#fix.modes, look);
  }
}
