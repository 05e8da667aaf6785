// node simplify.mjs NODE_MODULES JOBS OUT: npm's meshoptimizer on every mesh of JOBS.
// JOBS: 32-bit words: mesh count, 8 weights of attribute values (floats), then for each: vertices,
// indices, target index count, positions (3 floats a vertex), attribute values (8 floats a vertex;
// none if all weights are 0), indices. OUT: for each mesh the index count and the indices.
// Prints the CPU seconds of the calls alone, of a second pass: the first one warms the machine up.
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, jobsPath, outPath] = process.argv.slice(2);
const require = createRequire(resolve(modules, 'x.js'));
const { MeshoptSimplifier } = await import(pathToFileURL(require.resolve('meshoptimizer')).href);
await MeshoptSimplifier.ready;

const bytes = readFileSync(jobsPath);
const words = new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4);
const jobs = [];
const VALUES = 8;
const weights = Array.from(new Float32Array(words.buffer, words.byteOffset + 4, VALUES));
const weighted = weights.some((weight) => weight > 0);
let at = 1 + VALUES;
for (let mesh = 0; mesh < words[0]; ++mesh) {
  const [vertices, indices, target] = words.subarray(at, at + 3);
  at += 3;
  const positions = new Float32Array(words.buffer, words.byteOffset + 4 * at, 3 * vertices);
  at += 3 * vertices;
  const attributes = new Float32Array(
    words.buffer, words.byteOffset + 4 * at, weighted ? VALUES * vertices : 0);
  at += attributes.length;
  jobs.push({ positions, attributes, indices: words.slice(at, at + indices), target });
  at += indices;
}

const NO_ERROR_LIMIT = 1e10;
function simplifyAll() {
  let microseconds = 0;
  const results = jobs.map(({ positions, attributes, indices, target }) => {
    const start = process.cpuUsage();
    const [kept] = weighted
      ? MeshoptSimplifier.simplifyWithAttributes(
        indices, positions, 3, attributes, VALUES, weights, null, target, NO_ERROR_LIMIT)
      : MeshoptSimplifier.simplify(indices, positions, 3, target, NO_ERROR_LIMIT);
    const { user, system } = process.cpuUsage(start);
    microseconds += user + system;
    return kept;
  });
  return { results, seconds: microseconds / 1e6 };
}

simplifyAll();
const { results, seconds } = simplifyAll();
writeFileSync(outPath, Buffer.concat(results.flatMap((kept) => [
  Buffer.from(new Uint32Array([kept.length]).buffer),
  Buffer.from(kept.buffer, kept.byteOffset, kept.byteLength),
])));
console.log(seconds);
