// What the page asks and where it is told to begin: node question_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { load, run } from './page.mjs';

const { queryOf } = await load('question.js');
const { hashOf, shownBy } = await load('address.js');

const middle = { wrap: () => ({ lat: 37.5, lng: -179.5 }) };
const asked = (form) => Object.fromEntries(queryOf(Object.entries({ picture: {}, prior: 'map', ...form }), middle));

await run({
  'a frame from above is asked about with the size of its pixels'() {
    assert.deepEqual(asked({ what: 'gsd', gsd_m: '0.5', confidence: '0.99' }), { kind: 'frame', gsd_m: '0.5', confidence: '0.99' });
  },
  'what is left empty is not told'() {
    assert.deepEqual(asked({ what: 'camera', fov_deg: '78', focal_px: '', agl_m: '300', roll_deg: '', pitch_deg: '0', attitude_sigma_deg: '', scale_percent: '' }),
      { kind: 'frame', fov_deg: '78', agl_m: '300', pitch_deg: '0' });
    assert.deepEqual(asked({ what: 'cells', cell_m: '' }), { kind: 'feature_map' });
  },
  'a focal length counts for more than the angle that stands in the form'() {
    assert.deepEqual(asked({ what: 'camera', fov_deg: '78', focal_px: '900', agl_m: '300' }), { kind: 'frame', focal_px: '900', agl_m: '300' });
  },
  'a height above the sea counts for more than the one above ground that stands in the form'() {
    assert.deepEqual(asked({ what: 'camera', fov_deg: '78', agl_m: '300', alt_m: '930' }), { kind: 'frame', fov_deg: '78', alt_m: '930' });
    assert.deepEqual(asked({ what: 'camera', fov_deg: '78', agl_m: '300', alt_m: '' }), { kind: 'frame', fov_deg: '78', agl_m: '300' });
  },
  'a photo tells of its camera itself, and a size of the ground in per cent is told as a share'() {
    assert.deepEqual(asked({ what: 'exif', agl_m: '', scale_percent: '15' }), { kind: 'frame', exif: 'true', scale_range: '0.15' });
    assert.deepEqual(asked({ what: 'exif', agl_m: '', takeoff_alt_m: '655' }), { kind: 'frame', exif: 'true', takeoff_alt_m: '655' });
  },
  'a place to look around is the middle of the view, on the side of the 180th meridian that the service has'() {
    assert.deepEqual(asked({ what: 'gsd', gsd_m: '0.5', prior: 'circle', radius_m: '1000' }),
      { kind: 'frame', gsd_m: '0.5', radius_m: '1000', lat: '37.5', lon: '-179.5' });
  },
  'an address leads back to what the page showed'() {
    for (const map of ['city', 'a map & more=#', 'Şehir']) assert.deepEqual(shownBy(hashOf({ map, track: '' })), { map, track: null });
    assert.deepEqual(shownBy(hashOf({ map: 'city', track: '0123' })), { map: null, track: '0123' });
    assert.deepEqual(shownBy(''), { map: null, track: null });
  },
});
