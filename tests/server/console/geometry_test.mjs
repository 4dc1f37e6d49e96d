// Figures around places, against numbers: node geometry_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { load, run } from './page.mjs';

const { arrow, ellipse95, offset, square, towards } = await load('geometry.js');

const METRES_PER_DEGREE = 111_320;  // of a great circle
const AT_60 = [60, 10];             // where a degree of longitude is half as long as at the equator

/// How far east and north of AT_60, in metres.
function fromAt60([lat, lon]) {
  return [(lon - AT_60[1]) * METRES_PER_DEGREE / 2, (lat - AT_60[0]) * METRES_PER_DEGREE];
}

function near(actual, expected, within = 1e-6) {
  actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) <= within, `${actual} is not ${expected}`));
}

await run({
  'metres east and north become degrees, which are shorter towards the poles'() {
    near(offset([0, 10], METRES_PER_DEGREE, 0), [0, 11]);
    near(offset(AT_60, METRES_PER_DEGREE, METRES_PER_DEGREE), [61, 12]);
  },
  'an ellipse holds 95 %, with its long axis along the heading'() {
    const points = ellipse95(AT_60, [20, 5], 30).map(fromAt60);
    const lengths = points.map(([east, north]) => Math.hypot(east, north));
    near([Math.max(...lengths), Math.min(...lengths)], [2.4477 * 20, 2.4477 * 5], 1e-3);  // 5.991 = 2.4477^2 is the 95 % quantile of chi^2 in two dimensions
    const [east, north] = points[lengths.indexOf(Math.max(...lengths))];
    near([Math.abs(east / north)], [Math.tan(Math.PI / 6)], 1e-3);
    assert.ok(east * north > 0, 'clockwise from north');
  },
  'an arrow points where the vehicle does'() {
    const [from, to] = arrow(AT_60, 90, 60);
    near(fromAt60(from), [0, 0]);
    near(fromAt60(to), [60, 0]);
    near(fromAt60(arrow(AT_60, 180, 60)[1]), [0, -60]);
  },
  'a footprint is as wide as it is told'() {
    near(square(AT_60, 400).map(fromAt60).flat(), [-200, -200, -200, 200, 200, 200, 200, -200]);
  },
  'a longitude is that of the side that is shown'() {
    assert.equal(towards(-179.5, 179), 180.5);
    assert.equal(towards(179.5, -179), -180.5);
    assert.equal(towards(38, 37), 38);
    assert.equal(towards(38, 38 + 720), 38 + 720);
  },
});
