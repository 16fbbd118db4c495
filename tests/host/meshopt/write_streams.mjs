// Writes streams.glb, pairs of buffer views: a stream of the current encoder, and what its own decoder makes of it. Tests read the file; to
// write it anew: npm install meshoptimizer@1.3.0 && node write_streams.mjs
import { writeFileSync } from 'node:fs';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';

await MeshoptEncoder.ready;
await MeshoptDecoder.ready;

let state = 1;
function random() {
	state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
	return state / 2 ** 32;
}

// Of each kind, `count` elements of `stride` bytes.
const kinds = {
	noise: (count, stride) => Uint8Array.from({ length: count * stride }, () => 256 * random()),
	zeros: (count, stride) => new Uint8Array(count * stride),
	// Bytes that change by so much that groups of every bit length are worth it.
	steps: (count, stride) => {
		const bytes = new Uint8Array(count * stride);
		for (let i = stride; i < bytes.length; ++i) {
			const size = [0, 1, 2, 6, 100][(i % stride) % 5];
			const rare = Math.floor(i / stride / 16) % 3 == 0 || random() < 0.1;
			bytes[i] = bytes[i - stride] + (rare ? size * (2 * random() - 1) : 0);
		}
		return bytes;
	},
	shorts: (count, stride) => {
		const values = new Int16Array((count * stride) / 2);
		for (let i = 0; i < values.length; ++i) {
			values[i] = 20000 * Math.sin(0.01 * i) + 300 * random();
		}
		return new Uint8Array(values.buffer);
	},
	floats: (count, stride) => {
		const values = new Float32Array((count * stride) / 4);
		for (let i = 0; i < values.length; ++i) {
			values[i] = Math.sin(0.02 * i) + 2 * (i % 3);
		}
		return new Uint8Array(values.buffer);
	},
	// Words whose bits lie across bytes: floats without their lower bits, and flags.
	cut: (count, stride) => {
		const values = Float32Array.from({ length: (count * stride) / 4 }, () => random() - 0.5);
		return new Uint8Array(new Uint32Array(values.buffer).map((word) => word & 0xfff80000).buffer);
	},
	flags: (count, stride) => {
		return new Uint8Array(Uint32Array.from({ length: (count * stride) / 4 }, () => Math.floor(16 * random()) << 14).buffer);
	},
};

const unit = (v, size) => v.map((x, i) => (i < size ? x / Math.hypot(...v.slice(0, size)) : x));
const filters = {
	OCTAHEDRAL: [MeshoptEncoder.encodeFilterOct, (v) => unit(v, 3)],
	QUATERNION: [MeshoptEncoder.encodeFilterQuat, (v) => unit(v, 4)],
	EXPONENTIAL: [MeshoptEncoder.encodeFilterExp, (v) => v.map((x) => 1000 * x)],
	COLOR: [MeshoptEncoder.encodeFilterColor, (v) => v.map((x) => 0.5 + 0.5 * x)],
};

const pieces = [];
const views = [];
let end = 0;

function append(bytes) {
	const offset = end;
	pieces.push(bytes, new Uint8Array((4 - (bytes.length % 4)) % 4));
	end += bytes.length + pieces.at(-1).length;
	return { byteOffset: offset, byteLength: bytes.length };
}

function add(name, stream, count, byteStride, filter = 'NONE') {
	const decoded = new Uint8Array(count * byteStride);
	MeshoptDecoder.decodeGltfBuffer(decoded, count, byteStride, stream, 'ATTRIBUTES', filter);
	const source = { buffer: 0, ...append(stream), byteStride, count, mode: 'ATTRIBUTES', filter };
	views.push({ name, buffer: 1, byteLength: decoded.length, extensions: { KHR_meshopt_compression: source } });
	views.push({ name, buffer: 0, ...append(decoded) });
}

for (const [kind, make] of Object.entries(kinds)) {
	for (const [count, stride] of [[1, 4], [15, 8], [33, 12], [257, 4], [40, 256]]) {
		if ((kind == 'noise' || kind == 'zeros') && count > 40) {
			continue;
		}
		for (const [version, level] of [[0, 2], [1, 0], [1, 3]]) {
			if ((level != 3 && stride != 12) || (stride == 256 && kind != 'steps')) {
				continue;
			}
			const stream = MeshoptEncoder.encodeVertexBufferLevel(make(count, stride), count, stride, level, version);
			add(`${kind} ${count}x${stride}, version ${version}, level ${level}`, stream, count, stride);
		}
	}
}
for (const [filter, stride, bits] of [['OCTAHEDRAL', 4, 8], ['OCTAHEDRAL', 8, 12], ['QUATERNION', 8, 12], ['EXPONENTIAL', 16, 15],
	['COLOR', 4, 8], ['COLOR', 4, 5], ['COLOR', 4, 2], ['COLOR', 8, 16], ['COLOR', 8, 10]]) {
	const [encode, fit] = filters[filter];
	const values = Array.from({ length: 40 }, () => fit([0, 0, 0, 0].map(() => 2 * random() - 1))).flat();
	const encoded = encode(Float32Array.from(values), 40, stride, bits);
	add(`${filter} of ${bits} bits, stride ${stride}`, MeshoptEncoder.encodeVertexBufferLevel(encoded, 40, stride, 3, 1), 40, stride, filter);
}

let json = JSON.stringify({
	asset: { version: '2.0' },
	extensionsUsed: ['KHR_meshopt_compression'],
	extensionsRequired: ['KHR_meshopt_compression'],
	buffers: [{ byteLength: end }, { byteLength: 1 << 20, extensions: { KHR_meshopt_compression: { fallback: true } } }],
	bufferViews: views,
});
json += ' '.repeat((4 - (json.length % 4)) % 4);
const header = (...numbers) => new Uint8Array(Uint32Array.from(numbers).buffer);
const glb = [header(0x46546c67, 2, 28 + json.length + end, json.length, 0x4e4f534a), Buffer.from(json), header(end, 0x004e4942), ...pieces];
writeFileSync(new URL('streams.glb', import.meta.url), Buffer.concat(glb));
console.log(`${views.length / 2} streams, ${end} bytes`);
