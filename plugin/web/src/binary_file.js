// lacerta.wasm as the file beside this one.
export async function loadBinary(url = new URL('./lacerta.wasm', import.meta.url)) {
  if (String(url).startsWith('file:')) {  // Node.js
    const {readFile} = await import('node:fs/promises');
    return readFile(new URL(url));
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
