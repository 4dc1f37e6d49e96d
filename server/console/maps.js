// The list of maps as the page shows it: what an answer of /v1/maps makes of it while the operator's choice stays.

const STATES = { empty: 'nothing is ingested yet', incomplete: 'still being ingested', damaged: 'parts of it are lost' };

/// Whether there is ground to show and to search.
const usable = (map) => ['ready', 'incomplete', 'damaged'].includes(map.status) && map.bbox !== null;

function textOf(map) {
  const state = map.reason ?? STATES[map.status];
  return state ? `${map.name}: ${state}` : map.name;
}

/// The map to show: a wished one if it can be shown, else the chosen one as long as it is served, or was, else the
/// first with ground; null for none.
export function choiceOf(maps, chosen, wished = null) {
  if (maps.some((map) => map.name === wished && usable(map))) return wished;
  return chosen || (maps.find(usable)?.name ?? null);
}

/// Lines of the list. A chosen map that has left keeps its line, since its answers are still on the page.
export function linesOf(maps, chosen) {
  const lines = maps.map((map) => ({ name: map.name, text: textOf(map), disabled: !usable(map) }));
  if (chosen && !maps.some((map) => map.name === chosen)) {
    lines.push({ name: chosen, text: `${chosen}: no longer served`, disabled: true });
  }
  return lines;
}

/// Boxes in degrees: [west, south, east, north].
const meet = (a, b) => a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];

/// What a map says of the heights of its ground.
export function heightsOf({ terrain }) {
  if (!terrain) return 'heights of the ground not known';
  const share = terrain.known_share < 1 ? `, known on ${Math.floor(100 * terrain.known_share)} % of it` : '';
  return `ground ${Math.round(terrain.lowest_m)} to ${Math.round(terrain.highest_m)} m above the sea${share}`;
}

/// What is to be done on the page: 'open' another map, or one of elsewhere that has taken the name of the shown one;
/// 'redraw' the same one, whose content or heights changed; or nothing.
/// `shown` is the map on the page ({name, version, bbox, heights}, the last by heightsOf) or null, and its version null
/// while it is being opened.
export function stepTo(maps, chosen, shown) {
  const map = maps.find(({ name }) => name === chosen);
  if (!map || !usable(map)) return null;
  if (shown?.name !== chosen) return 'open';
  if (shown.version === null || (shown.version === map.version && shown.heights === heightsOf(map))) return null;
  return meet(shown.bbox, map.bbox) ? 'redraw' : 'open';
}
