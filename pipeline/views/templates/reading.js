// Reads what the page holds: CSV files of figures, plain or zipped, and deflated arrays.
"use strict";
const reading = (() => {
  const bytes = base64 => Uint8Array.from(atob(base64), c => c.charCodeAt(0));
  const inflated = packed => new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw")));

  // text of the file of a data URI; of a zip archive, its only file
  async function text(address) {
    const [head, body] = address.split(",");
    const content = bytes(body);
    if (!head.includes("zip")) return new TextDecoder().decode(content);
    const view = new DataView(content.buffer);
    const begin = 30 + view.getUint16(26, true) + view.getUint16(28, true);
    return inflated(content.subarray(begin, begin + view.getUint32(18, true))).text();
  }

  function cells(line) {
    return [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^",]*))/g)].map(m => m[1]?.replaceAll('""', '"') ?? m[2]);
  }

  async function integers(base64) {
    return new Uint32Array(await inflated(bytes(base64)).arrayBuffer());
  }

  return {text, cells, integers};
})();
