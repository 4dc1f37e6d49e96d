// The list of maps as the page shows it: what an answer of /v1/maps makes of it while the operator's choice stays.

const STATES = { empty: 'nothing is ingested yet', incomplete: 'still being ingested' };

/// Whether there is ground to show and to search.
const usable = (map) => map.status === 'ready' || map.status === 'incomplete';

function textOf(map) {
  const state = map.reason ?? STATES[map.status];
  return state ? `${map.name}: ${state}` : map.name;
}

/// The map to show: the chosen one as long as it is served, or was; else the first with ground; null for none.
export function choiceOf(maps, chosen) {
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

/// What is to be done on the page: 'open' another map, 'redraw' the same one, whose content changed, or nothing.
/// `shown` is the map on the page ({name, version}) or null, and its version null while it is being opened.
export function stepTo(maps, chosen, shown) {
  const map = maps.find(({ name }) => name === chosen);
  if (!map || !usable(map)) return null;
  if (shown?.name !== chosen) return 'open';
  return shown.version !== null && shown.version !== map.version ? 'redraw' : null;
}
