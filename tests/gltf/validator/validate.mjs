// Packs and unpacks meshes and assets in every way and runs the Khronos glTF validator over what comes out.
//   node validate.mjs LACERTA FILE...
// Fails when an output has an error that its input does not have. Extensions that the validator does not know are no error.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {basename, join} from 'node:path';
import validator from 'gltf-validator';

const [lacerta, ...inputs] = process.argv.slice(2);
if (lacerta === undefined || inputs.length === 0) {
  console.error('usage: node validate.mjs LACERTA FILE...');
  process.exit(1);
}

// Exit code 5 stands for an output that misses its target: it has to be valid all the same.
function run(...args) {
  try {
    execFileSync(lacerta, args, {stdio: ['ignore', 'ignore', 'pipe']});
  } catch (error) {
    if (error.status !== 5) throw error;
  }
}

async function errorsOf(file) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {maxIssues: 0});
  return report.issues.messages.filter((message) => message.severity === 0);
}

const folder = mkdtempSync(join(tmpdir(), 'lacerta-validate-'));
let failures = 0;
let checked = 0;
try {
  for (const input of inputs) {
    const known = new Set(input.endsWith('.glb') ? (await errorsOf(input)).map((message) => message.code) : []);
    for (const fallback of ['draco', 'plain', 'none']) {
      const packed = join(folder, 'packed.glb');
      const outputs = [[`packed with fallback ${fallback}`, packed]];
      run('pack', input, '-o', packed, '--fallback', fallback);
      for (const level of ['0', '1', '']) {
        const unpacked = join(folder, `unpacked${level}.glb`);
        run('unpack', packed, '-o', unpacked, ...(level === '' ? [] : ['--level', level]));
        outputs.push([`unpacked from fallback ${fallback}, level ${level || 'finest'}`, unpacked]);
      }
      for (const [what, file] of outputs) {
        ++checked;
        const errors = (await errorsOf(file)).filter((message) => !known.has(message.code));
        if (errors.length === 0) continue;
        ++failures;
        console.error(`${basename(input)}, ${what}: ${errors.length} errors`);
        for (const error of errors.slice(0, 3)) console.error(`  ${error.code} ${error.pointer ?? ''} ${error.message}`);
      }
    }
    console.log(`${basename(input)}: done`);
  }
} finally {
  rmSync(folder, {recursive: true});
}
console.log(`${checked} outputs checked, ${failures} with errors`);
process.exit(failures === 0 && checked > 0 ? 0 : 1);
