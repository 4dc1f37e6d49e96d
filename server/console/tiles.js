// Tiles of the map and of what lies over it. A browser opens six connections to a service: with more tiles at a time,
// what is asked of a track would wait behind pictures that come over a slow link or are searched for, until it is given up.
// Two of the map, two of what lies over it and the line of a track leave one.

const FIRST_PAUSE_MS = 1000;
const LONGEST_PAUSE_MS = 10_000;

const pauseBefore = (tries) => Math.min(FIRST_PAUSE_MS * 2 ** tries, LONGEST_PAUSE_MS);

class Turns {
  #waiting = [];

  constructor(free) {
    this.free = free;
  }

  async take(work) {
    if (this.free) this.free -= 1;
    else await new Promise((go) => { this.#waiting.push(go); });
    try {
      return await work();
    } finally {
      const next = this.#waiting.shift();
      if (next) next();
      else this.free += 1;
    }
  }
}

/// Whether the picture came. Leaflet ends the loading of a tile that it takes off the page by another picture.
function loaded(tile, url) {
  return new Promise((tell) => {
    tile.addEventListener('load', () => tell(true), { once: true });
    tile.addEventListener('error', () => tell(false), { once: true });
    tile.src = url;
  });
}

/// 'shown', 'empty' or 'failed'. An <img> does not tell ground of which there is nothing to show (204) from a service that
/// is away.
async function fetched(tile, url) {
  if (!tile.isConnected) return 'failed';
  if (await loaded(tile, url)) return 'shown';
  const answer = await fetch(url).catch(() => null);
  return answer?.status === 204 ? 'empty' : 'failed';
}

/// 'shown' or 'empty'. Asks again, with growing pauses, for as long as the tile is on the page: then 'failed'. One that ran
/// out of time goes on where it was.
async function bring(tile, url, turns) {
  await null;  // so that Leaflet has put it on the page
  for (let tries = 0; tile.isConnected; tries += 1) {
    const came = await turns.take(() => fetched(tile, url));
    if (came !== 'failed') return came;
    await new Promise((go) => { setTimeout(go, pauseBefore(tries)); });
  }
  return 'failed';
}

/// As L.tileLayer, with so many tiles on their way at a time.
export function tilesOf(url, options, atATime) {
  const layer = L.tileLayer(url, options);
  const turns = new Turns(atATime);
  layer.createTile = (coords, done) => {
    const tile = document.createElement('img');
    tile.alt = '';
    // Leaflet shows no tile that has come with an error.
    bring(tile, layer.getTileUrl(coords), turns).then((came) => { if (tile.isConnected) done(came === 'empty', tile); });
    return tile;
  };
  return layer;
}
