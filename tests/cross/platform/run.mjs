// Runs a WebAssembly program of tests/cross under Node: node run.mjs PROGRAM.
import { readFileSync, writeSync } from 'node:fs';

let text = '';
const host = {
    print: (address, length) => {
        text += new TextDecoder('latin1').decode(new Uint8Array(instance.exports.memory.buffer, address, length));
    },
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { host });
process.exitCode = instance.exports.run();
writeSync(1, text);
