// What the page shows, as the end of its address: #map=NAME or #track=ID.

export function shownBy(hash) {
  const named = new URLSearchParams(hash.slice(1));
  return { map: named.get('map'), track: named.get('track') };
}

/// A track is shown on its map.
export function hashOf({ map, track }) {
  return `#${new URLSearchParams(track ? { track } : { map })}`;
}
