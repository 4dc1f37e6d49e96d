// The form of the page as the query of a fix.

/// `form`: name and value of each field that counts; `centre`: the middle of the view, as Leaflet has it.
export function queryOf(form, centre) {
  const { picture, what, prior, scale_percent: percent, ...numbers } = Object.fromEntries(form);
  if (numbers.focal_px) delete numbers.fov_deg;
  if (numbers.alt_m) delete numbers.agl_m;
  const told = Object.entries(numbers).filter(([, value]) => value !== '');
  const query = new URLSearchParams([['kind', what === 'cells' ? 'feature_map' : 'frame'], ...told]);
  if (what === 'exif') query.set('exif', true);
  if (percent) query.set('scale_range', percent / 100);
  if (prior === 'circle') {
    const { lat, lng } = centre.wrap();
    query.set('lat', lat);
    query.set('lon', lng);
  }
  return query;
}
