// A file on its way to the service. Over a slow link it is the sending that takes long, and fetch() does not tell how
// much of it is done; XMLHttpRequest does.

/// A browser gives no bytes of a file that was written anew since it was chosen.
export async function bytesOf(file, signal) {
  const bytes = await file.arrayBuffer().catch(() => null);
  signal.throwIfAborted();
  if (bytes) return bytes;
  throw { title: 'The file cannot be read', detail: 'it was changed or removed since it was chosen: choose it again' };
}

/// As fetch() with { method, body, headers, signal }; tells `progress` how many bytes are sent.
export function upload(url, { method, body, headers, signal, progress }) {
  return new Promise((resolve, reject) => {
    signal.throwIfAborted();
    const sending = new XMLHttpRequest();
    sending.open(method, url);
    for (const [name, value] of Object.entries(headers)) sending.setRequestHeader(name, value);
    sending.upload.onprogress = ({ loaded }) => { if (!signal.aborted) progress(loaded); };
    sending.upload.onload = () => { if (!signal.aborted) progress(body.byteLength); };
    sending.onload = () => {
      const { status, responseText } = sending;
      resolve({ status, ok: status >= 200 && status < 300, json: async () => JSON.parse(responseText) });
    };
    sending.onerror = () => reject(new TypeError('the connection failed'));
    sending.onabort = () => reject(signal.reason);
    signal.addEventListener('abort', () => sending.abort());
    sending.send(body);
  });
}
