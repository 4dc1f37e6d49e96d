// Tiles that did not come. An <img> tells no more of it than that: ground of which there is nothing to show (204) is an
// error to it as much as a service that is away, so the service is asked which of them it is.

const FIRST_PAUSE_MS = 1000;
const LONGEST_PAUSE_MS = 10_000;

const pauseBefore = (tries) => Math.min(FIRST_PAUSE_MS * 2 ** tries, LONGEST_PAUSE_MS);

/// 'none' to show, 'ready' to be shown, or 'failed'.
async function stateOf(url) {
  try {
    const answer = await fetch(url);
    if (answer.status === 204) return 'none';
    return answer.ok ? 'ready' : 'failed';
  } catch {
    return 'failed';
  }
}

/// For the event 'tileerror' of a layer: asks again, with growing pauses, for as long as the tile is on the page. One that
/// ran out of time goes on where it was.
export async function askAgain({ tile }) {
  const url = tile.src;
  for (let tries = Number(tile.dataset.tries ?? 0); ; tries += 1) {
    await new Promise((go) => { setTimeout(go, pauseBefore(tries)); });
    if (!tile.isConnected) return;
    const state = await stateOf(url);
    if (state === 'none') return;
    if (state === 'failed') continue;
    tile.dataset.tries = tries + 1;  // a picture that is broken is an error again
    tile.src = url;
    return;
  }
}
