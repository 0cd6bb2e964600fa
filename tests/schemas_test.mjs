// Does each JSON file that the program writes, and each that it comes with, keep to its schema?
//     node schemas_test.mjs RETROLUX_BINARY [STUDY_FOLDER]
// Makes small outputs in a folder of its own under TMPDIR, removed at the end; with the folder of a
// finished marker study, that is checked instead of a new small one. The schema of a file that says
// "schema": "retrolux/NAME" is scenes/schema/NAME.schema.json. Prints a line for each violation.
// Exit codes: 0 good, 1 violations, 2 not to be run.
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const ROOT = fileURLToPath(new URL('..', import.meta.url));
const SCHEMAS = path.join(ROOT, 'scenes', 'schema');
const ENDING = '.schema.json';
const LIMIT_MS = 300000; // of a command

function leave(message) {
  console.error(`schemas_test: ${message}`);
  process.exit(2);
}

function loadValidator() {
  try {
    const require = createRequire(path.join(ROOT, 'analysis', 'report', 'package.json'));
    return require('ajv/dist/2020').default;
  } catch {
    return leave('ajv is not installed (npm ci in analysis/report); run scripts/setup.sh');
  }
}

if (process.argv.length < 3 || process.argv.length > 4)
  leave('usage: schemas_test.mjs RETROLUX_BINARY [STUDY_FOLDER]');
const binary = path.resolve(process.argv[2]);
const givenStudy = process.argv[3] && path.resolve(process.argv[3]);
const Ajv = loadValidator();

const violations = [];
const checked = new Map(); // schema name -> documents

/** Comments become blanks; what looks like one within a string stays. */
const withoutComments = (text) =>
  text.replace(/"(?:[^"\\]|\\.)*"|\/\/[^\n]*|\/\*[\s\S]*?\*\//g, (m) => (m[0] === '"' ? m : ' '));

/**
 * Of a value that fits none of several alternatives, only the errors of the one it is meant to be:
 * where types and constants fit, with the fewest errors. If several are as near, one error that
 * names them all.
 */
function withoutOtherAlternatives(errors) {
  // Beside these two stands what failed.
  let left = errors.filter((e) => e.keyword !== 'if' && e.keyword !== 'propertyNames');
  // ajv lists the errors of the alternatives before the oneOf that failed: the innermost first.
  const noneFits = (e) => e.keyword === 'oneOf' && e.params.passingSchemas === null;
  for (const whole of errors.filter(noneFits)) {
    const place = whole.instancePath;
    const below = (e) => e.instancePath === place || e.instancePath.startsWith(`${place}/`);
    const alternatives = new Map();
    for (const e of left) {
      if (!below(e) || !e.schemaPath.startsWith(`${whole.schemaPath}/`)) continue;
      const number = e.schemaPath.slice(whole.schemaPath.length + 1).split('/')[0];
      alternatives.set(number, [...(alternatives.get(number) ?? []), e]);
    }
    const all = [...alternatives.values()];
    const other = (e) =>
      (e.keyword === 'type' && e.instancePath === place) ||
      (e.keyword === 'const' && e.instancePath === `${place}/type`);
    const meant = all.filter((list) => !list.some(other));
    const fewest = Math.min(...meant.map((list) => list.length));
    const nearest = meant.filter((list) => list.length === fewest);
    const dropped = new Set([whole, ...all.flat()]);
    left = left.filter((e) => !dropped.has(e));
    if (nearest.length === 1) {
      left.push(...nearest[0]);
    } else if (nearest.length > 1) {
      const messages = new Set(nearest.map((list) => list[0].message));
      left.push({ ...nearest[0][0], message: [...messages].join(' or ') });
    } else if (!left.some(below)) {
      left.push(whole); // else an alternative that is a $ref tells more
    }
  }
  return left;
}

function describe(error) {
  const { params } = error;
  const detail =
    params.additionalProperty ??
    params.unevaluatedProperty ??
    params.allowedValues?.join(', ') ??
    JSON.stringify(params.allowedValue) ??
    error.propertyName ??
    '';
  return `${error.instancePath || '/'}: ${error.message}${detail === '' ? '' : ` (${detail})`}`;
}

function loadSchemas() {
  const ajv = new Ajv({ allErrors: true, strict: true, strictRequired: false });
  const schemas = new Map();
  for (const file of fs.readdirSync(SCHEMAS).sort()) {
    const name = `retrolux/${file.slice(0, -ENDING.length)}`;
    try {
      const schema = JSON.parse(fs.readFileSync(path.join(SCHEMAS, file), 'utf8'));
      if (!file.endsWith(ENDING) || schema.$id !== name || schema.properties.schema.const !== name)
        violations.push(`${file}: $id and properties/schema should be "${name}", as its file`);
      schemas.set(name, { schema, validate: ajv.compile(schema) });
    } catch (error) {
      violations.push(`${file}: ${error.message}`);
    }
  }
  return schemas;
}

/** The value keeps to its schema, which is no sieve: it refuses a key more and a key less. */
function checkDocument(schemas, name, value) {
  const entry = schemas.get(value?.schema);
  if (!entry) {
    const found = JSON.stringify(value?.schema);
    violations.push(`${name}: /schema: no schema is published for ${found}`);
    return;
  }
  const { schema, validate } = entry;
  checked.set(value.schema, (checked.get(value.schema) ?? 0) + 1);
  if (!validate(value)) {
    const errors = withoutOtherAlternatives(validate.errors);
    violations.push(...errors.map((error) => `${name}: ${describe(error)}`));
    return;
  }
  if (validate({ ...value, no_such_key: 0 }))
    violations.push(`${value.schema}: allows unknown keys in ${name}`);
  for (const key of schema.required) {
    const { [key]: _, ...rest } = value;
    if (validate(rest)) violations.push(`${value.schema}: allows ${name} without '${key}'`);
  }
}

function checkText(schemas, name, text) {
  let value;
  try {
    value = JSON.parse(text);
  } catch (error) {
    violations.push(`${name}: no JSON: ${error.message}`);
    return;
  }
  checkDocument(schemas, name, value);
}

/** All JSON files below a folder; how many there are. */
function checkFolder(schemas, folder, name) {
  const files = fs.readdirSync(folder, { withFileTypes: true });
  let found = 0;
  for (const file of files) {
    const place = path.join(folder, file.name);
    if (file.isDirectory()) {
      found += checkFolder(schemas, place, `${name}/${file.name}`);
    } else if (file.name.endsWith('.json')) {
      checkText(schemas, `${name}/${file.name}`, fs.readFileSync(place, 'utf8'));
      ++found;
    }
  }
  return found;
}

/** Standard output of the program, or null and a violation. */
function run(work, ...args) {
  const options = { cwd: work, encoding: 'utf8', timeout: LIMIT_MS, maxBuffer: 1 << 26 };
  const done = spawnSync(binary, args, options);
  if (done.status === 0) return done.stdout;
  const lastLine = done.stderr?.trim().split('\n').at(-1);
  const why = done.error?.message ?? `exit code ${done.status ?? done.signal}: ${lastLine}`;
  violations.push(`retrolux ${args.join(' ')}: ${why}`);
  return null;
}

/** A scenario of three orientations and a few placements. */
const TINY_SCENARIO = {
  schema: 'retrolux/scenario-1',
  base: '1a',
  name: 'tiny',
  cameras: { width_px: 160, height_px: 120 },
  masks: { face: { x_deg: [0], y_deg: [-10], z_deg: { from: 0, to: 180, step: 90 } } },
  search: {
    phi_b_deg: { from: 40, to: 60, step: 20 },
    theta_deg: { from: 31.67, to: 70.52, step: 38.85 },
    refined_phi_b_step_deg: 10,
    refined_theta_step_deg: 38.85,
    refined_optima: 1,
  },
  variations: [],
};

function checkVault(schemas, work) {
  const change = { nozzle: { tip_radius_mm: 80 } };
  const varied = structuredClone(TINY_SCENARIO);
  varied.name = 'varied';
  varied.search.phi_b_deg.to = 80; // more than a step from the optimum: there is a runner-up
  varied.variations = [{ name: 'slim', change }];
  for (const scenario of [TINY_SCENARIO, varied])
    fs.writeFileSync(path.join(work, `${scenario.name}.json`), JSON.stringify(scenario));
  const vault = ['study', 'vault', '--visibility', 'rays', '--sample-area', '40'];
  const quick = [...vault, '--scenario', 'tiny.json', '--quick', '--json', '--out', 'vault-quick'];
  const output = run(work, ...quick);
  if (output !== null) {
    for (const solution of JSON.parse(output))
      checkDocument(schemas, 'standard output of study vault --json', solution);
  }
  run(work, ...vault, '--scenario', 'varied.json', '--phase', '1', '--out', 'vault-whole');
  const found = path.join(work, 'vault-whole', 'solution.json');
  if (!fs.existsSync(found)) return;
  checkRefused(schemas, 'solution', JSON.parse(fs.readFileSync(found, 'utf8')), BAD_SOLUTIONS);
}

/** A picture of a mask with two markers. */
const TINY_DATASET = {
  schema: 'retrolux/dataset-1',
  name: 'tiny',
  licence: 'CC0-1.0',
  scenes: 1,
  spp: 1,
  masks: [{ mesh: 'oval' }],
  views: [{ kind: 'free', distance_mm: { log: [1200, 1600] }, incidence_deg: [0, 30] }],
  markers: { identifiable: 2, standard: [0, 1], polarity: { bright: 1, dark: 1 } },
  recording: { size_px: [96, 72] },
  distractors: { glints: { probability: 1 }, second_ring: { probability: 1, separation_deg: 5 } },
};

/** What is wrong with a config; makes it so. */
const BAD_DATASETS = {
  'no licence': (d) => delete d.licence,
  'half a scene': (d) => (d.scenes = 0.5),
  'no mask': (d) => (d.masks = []),
  'an unknown kind of view': (d) => (d.views[0].kind = 'attic'),
  'a distance in a room': (d) => (d.views[0] = { kind: 'vault', distance_mm: 1600 }),
  'a range of three numbers': (d) => (d.recording.exposure = [1, 2, 3]),
  'an unknown distractor': (d) => (d.distractors.dust = { probability: 1 }),
  'glints without a probability': (d) => (d.distractors.glints = { count: 3 }),
  'a probability of 2': (d) => (d.markers.touching = 2),
  'an unknown sensor': (d) => (d.recording.sensor = 'film'),
};

function checkDataset(schemas, work) {
  fs.writeFileSync(path.join(work, 'tiny-dataset.json'), JSON.stringify(TINY_DATASET));
  run(work, 'dataset', 'plan', 'tiny-dataset.json', '--out', 'dataset');
  run(work, 'dataset', 'run', 'dataset');
  run(work, 'evaluate', 'dataset', '--split', 'all', '--out', 'evaluation');
  checkRefused(schemas, 'dataset', TINY_DATASET, BAD_DATASETS);
  // A folder in a picture's place makes its scene fail.
  run(work, 'dataset', 'plan', 'tiny-dataset.json', '--out', 'dataset-failed');
  fs.mkdirSync(path.join(work, 'dataset-failed', 'images', 'scene-00000_camera-1.png'));
  const failed = spawnSync(binary, ['dataset', 'run', 'dataset-failed'], { cwd: work });
  if (failed.status !== 4) violations.push(`a scene that fails: exit code ${failed.status}, not 4`);
}

/** Two cameras that look at the oval's markers, and what is made of their pictures. */
function checkStereo(schemas, work) {
  const scene = JSON.parse(fs.readFileSync(path.join(work, 'scene-oval', 'scene.json'), 'utf8'));
  const { R, t_mm, ...camera } = scene.cameras[0];
  scene.cameras = [15, -15].map((deg) => {
    const [x, y] = [Math.cos, Math.sin].map((f) => 1600 * f((deg * Math.PI) / 180));
    return { ...camera, name: `at${deg}`, eye_mm: [x, y, 0], look_at_mm: [0, 0, 0], up: [0, 0, 1] };
  });
  fs.writeFileSync(path.join(work, 'scene-oval', 'pair.json'), JSON.stringify(scene));
  run(work, 'render', 'scene-oval/pair.json', '--spp', '1', '--out', 'pair');
  const output = run(work, 'stereo', 'pair', '--json', '--out', 'stereo');
  if (output !== null) checkText(schemas, 'standard output of stereo --json', output);
  run(work, 'stereo', 'room', '--out', 'stereo-room'); // nothing is found in pictures so small
  const study = run(work, 'study', 'stereo', '--quick', '--json', '--out', 'stereo-study');
  if (study !== null) checkText(schemas, 'standard output of study stereo --json', study);
  run(work, 'study', 'motion', '--frames', '14', '--spp', '1', '--out', 'motion');
  const few = ['--angles', '5', '--variations', 'none', '--scene', 'none', '--placements', '1'];
  const least = ['--exposures', '2', '--spp', '1'];
  const hot = run(work, 'study', 'hotspot', ...few, ...least, '--json', '--out', 'hotspot');
  if (hot !== null) checkText(schemas, 'standard output of study hotspot --json', hot);
  const vault = { schema: 'retrolux/scenario-1', base: '1a', name: 'three', cameras: { count: 3 } };
  vault.masks = { face: { x_deg: [0], y_deg: [10], z_deg: [40] } };
  vault.combinations = { extra: [] };
  fs.writeFileSync(path.join(work, 'three.json'), JSON.stringify(vault));
  const placed = ['--placement', 'vault-whole/solution.json', '--scenario', 'three.json'];
  run(work, 'study', 'hotspot', ...placed, ...least, '--out', 'hotspot-placed');
}

/** Six markers on the oval, in one pose. */
function checkLayout(schemas, work) {
  const once = ['--poses', 'reference', '--spp', '1', '--max-incidence', '40'];
  const output = run(work, 'study', 'layout', ...once, '--json', '--out', 'layout');
  if (output !== null) checkText(schemas, 'standard output of study layout --json', output);
}

function checkOutputs(schemas, work) {
  run(work, 'render', 'oval', '--size', '64x48', '--spp', '1', '--out', 'small');
  run(work, 'render', 'oval', '--size', '64x48', '--ids-only', '--out', 'ids');
  run(work, 'render', 'oval', '--spp', '1', '--out', 'full'); // large enough to identify markers
  const two = ['--camera', 'back-left,front-middle', '--pose', 'start'];
  run(work, 'render', 'ct-room', '--size', '32x24', '--spp', '1', ...two, '--out', 'room');
  for (const scene of ['oval', 'ct-room'])
    run(work, 'scene', 'export', scene, '--out', `scene-${scene}`);
  const pictures = ['small/camera.png', 'full/camera.png', 'room/back-left.png'];
  run(work, 'classify', ...pictures, '--out', 'detections.json');
  if (!givenStudy) {
    const coarse = ['--stride', '14', '--spp', '1', '--poses', 'reference'];
    const output = run(work, 'study', 'markers', ...coarse, '--json', '--out', 'study');
    if (output !== null) checkText(schemas, 'standard output of study markers --json', output);
  }
  checkVault(schemas, work);
  checkStereo(schemas, work); // with a placement of checkVault
  checkLayout(schemas, work);
  checkDataset(schemas, work);
  const small = ['--triangles', '1280', '--sample-area', '4', '--size', '160x120'];
  const areas = run(work, 'study', 'areas', ...small, '--json', '--out', 'areas');
  if (areas !== null) checkText(schemas, 'standard output of study areas --json', areas);
  const checks = run(work, 'validate', '--only', 'filter', '--json', '--out', 'validated');
  if (checks !== null) checkText(schemas, 'standard output of validate --json', checks);
  checkFolder(schemas, work, 'out');
}

/** What is wrong with a scenario or solution; makes it so. */
const BAD_SCENARIOS = {
  'a step of 0': (s) => (s.search.theta_deg.step = 0),
  'theta 181': (s) => (s.search.theta_deg.to = 181),
  'one camera': (s) => (s.cameras.count = 1),
  'half a camera': (s) => (s.cameras.count = 8.5),
  'an unknown arrangement': (s) => (s.cameras.arrangement = 'around'),
  'an unknown key of the search': (s) => (s.search.phi_d = 3),
  'an unknown key of a mask': (s) => (s.masks.face.colour = 'red'),
  'a mask without a mesh': (s) => delete s.masks.face.mesh,
  'no mask': (s) => (s.masks = {}),
  'a mask that is null, with no base': (s) => (s.masks.body = null),
  'no angle': (s) => (s.masks.face.x_deg = []),
  'an interval without its end': (s) => delete s.masks.face.z_deg.to,
  'rotations about x twice': (s) => (s.masks.face.order = 'xxz'),
  'no nozzle': (s) => delete s.nozzle,
  'a nozzle without its gap': (s) => delete s.nozzle.gap_mm,
  'a snout without length': (s) => (s.nozzle.snout_length_mm = 0),
  'a camera twice': (s) => (s.combinations.extra = [[1, 1, 2]]),
  'camera 0': (s) => (s.combinations.extra = [[0, 1, 2]]),
  'five cameras together': (s) => (s.combinations.size = 5),
  'two known errors': (s) => (s.reconstruction_error.points.length = 2),
  'an error without its angle': (s) => (s.reconstruction_error.points[0] = [1.5]),
  'a variation without its change': (s) => delete s.variations[0].change,
  'an unknown key of a change': (s) => (s.variations[0].change.nozle = {}),
  'a base that is a number': (s) => (s.base = 1),
};
const BAD_SOLUTIONS = {
  'a placement without theta_2': (s) => delete s.placement.theta2_deg,
  'theta 181': (s) => (s.placement.theta1_deg = 181),
  'a cost that is null': (s) => (s.cost = null),
  'three rigs': (s) => s.rig_heights_mm.push(2000),
  'a camera that is text': (s) => (s.combination = ['1']),
  'camera 0': (s) => (s.combination = [0, 1, 2]),
  'a row of the thesis with an unknown key': (s) => (s.thesis[0].no_such_key = 0),
  'a row of the thesis without what it prints': (s) => delete s.thesis[0].printed,
  'a runner-up without a name': (s) => delete s.runner_up.name,
  'a moved optimum without a name': (s) => delete s.sensitivity[0].name,
  'no snapped placement, as 0': (s) => (s.snapped = 0),
  'a refinement without its cost': (s) => delete s.refined.cost,
  'a variation without a placement': (s) => delete s.variations[0].placement,
};

/** A good document, and what is refused of it. */
function checkRefused(schemas, name, good, wrongs) {
  const validate = schemas.get(good.schema)?.validate;
  if (!validate?.(good)) violations.push(`${name}: to be good before it is made wrong`);
  for (const [what, spoil] of Object.entries(wrongs)) {
    const wrong = structuredClone(good);
    spoil(wrong);
    if (validate?.(wrong)) violations.push(`${good.schema}: allows a ${name} with ${what}`);
  }
}

/** The built-in scenarios and the vault that they share, and the configs of datasets. */
function checkScenarios(schemas) {
  const folder = path.join(ROOT, 'scenes', 'data');
  const read = (file) => withoutComments(fs.readFileSync(path.join(folder, file), 'utf8'));
  const filesOf = (name) => fs.readdirSync(path.join(folder, name)).map((file) => `${name}/${file}`);
  for (const file of ['vault.json', ...filesOf('scenarios').sort(), ...filesOf('datasets').sort()])
    checkText(schemas, `scenes/data/${file}`, read(file));
  checkRefused(schemas, 'scenario', JSON.parse(read('vault.json')), BAD_SCENARIOS);
}

/** Both schemas say the same of a material, but for words. */
function checkMaterials(schemas) {
  const plain = (node) => {
    if (Array.isArray(node)) return node.map(plain);
    if (node === null || typeof node !== 'object') return node;
    const keys = Object.keys(node).sort();
    return Object.fromEntries(
      keys.filter((key) => key !== 'description').map((key) => [key, plain(node[key])]),
    );
  };
  const types = (name) => {
    const all = schemas.get(name)?.schema.$defs.material.oneOf ?? [];
    return all.filter((type) => type.properties.type).map((type) => JSON.stringify(plain(type)));
  };
  const [library, scene] = [types('retrolux/materials-1'), types('retrolux/scene-1')];
  for (const type of library.filter((t) => !scene.includes(t)))
    violations.push(`materials-1 has a material that scene-1 has not: ${type}`);
  for (const type of scene.filter((t) => !library.includes(t)))
    violations.push(`scene-1 has a material that materials-1 has not: ${type}`);
}

const schemas = loadSchemas();
checkMaterials(schemas);
const LIBRARIES = [
  'scenes/data/markers.json',
  'scenes/data/sensors.json',
  'materials/data/library.json',
];
for (const file of LIBRARIES)
  checkText(schemas, file, withoutComments(fs.readFileSync(path.join(ROOT, file), 'utf8')));
checkScenarios(schemas);
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'retrolux_schemas.'));
try {
  checkOutputs(schemas, work);
} finally {
  fs.rmSync(work, { recursive: true, force: true });
}
if (givenStudy) {
  const there = fs.statSync(givenStudy, { throwIfNoEntry: false })?.isDirectory();
  const found = there ? checkFolder(schemas, givenStudy, path.basename(givenStudy)) : 0;
  if (found === 0) violations.push(`${process.argv[3]}: no folder with JSON files`);
}
for (const name of schemas.keys())
  if (!checked.has(name)) violations.push(`${name}: no file of this schema was checked`);

for (const violation of violations) console.log(violation);
const documents = [...checked.values()].reduce((sum, count) => sum + count, 0);
const sum = `${documents} files of ${checked.size} schemas, ${violations.length} violations`;
console.log(`schemas_test: ${sum}`);
process.exit(violations.length > 0 ? 1 : 0);
