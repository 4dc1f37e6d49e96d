// Small figures around a place, as latitudes and longitudes. Metres are laid out on the plane that touches the Earth
// there, which is good to a millimetre over a kilometre at this purpose.

const METRES_PER_DEGREE = 111_320;
/// Of a normal distribution on the plane: 95 % lies within so many standard deviations.
const WITHIN_95 = Math.sqrt(-2 * Math.log(0.05));

const radians = (degrees) => (degrees * Math.PI) / 180;

export function offset([lat, lon], eastM, northM) {
  return [lat + northM / METRES_PER_DEGREE, lon + eastM / (METRES_PER_DEGREE * Math.cos(radians(lat)))];
}

/// The longitude of the same place that lies nearest to another one: maps may cross the 180th meridian.
export const towards = (lon, other) => lon + 360 * Math.round((other - lon) / 360);

/// Axes in metres; `headingDeg` of the long one, clockwise from north.
export function ellipse95(centre, [longSigma, shortSigma], headingDeg) {
  const s = Math.sin(radians(headingDeg));
  const c = Math.cos(radians(headingDeg));
  return Array.from({ length: 48 }, (_, i) => {
    const angle = (2 * Math.PI * i) / 48;
    const along = WITHIN_95 * longSigma * Math.cos(angle);
    const across = WITHIN_95 * shortSigma * Math.sin(angle);
    return offset(centre, along * s + across * c, along * c - across * s);
  });
}

export function arrow(centre, headingDeg, lengthM) {
  return [centre, offset(centre, lengthM * Math.sin(radians(headingDeg)), lengthM * Math.cos(radians(headingDeg)))];
}

export function square(centre, sideM) {
  const half = sideM / 2;
  return [[-1, -1], [-1, 1], [1, 1], [1, -1]].map(([x, y]) => offset(centre, x * half, y * half));
}
