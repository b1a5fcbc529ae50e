// The folders that the pages are made of, by the real binary.

import { execFileSync, spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';

export const kAlbedo = [0.9, 0.6, 0.2];
export const kOtherAlbedo = [0.35, 1, 0];

// pictures: a folder with bricks.png, which stands for one of 'hemibake render'.
export function makeBakes(hemibake, folder, pictures) {
  // A map without an answer to fit is exit 1; the folder is whole all the same.
  const run = (...options) => {
    const result = spawnSync(hemibake, options, { cwd: folder, encoding: 'utf8' });
    if (result.status > 1) throw new Error(result.stderr);
    return result.stdout;
  };
  const report = (name, ...options) =>
    JSON.parse(execFileSync(hemibake, ['report', name, '--json', ...options], { cwd: folder, encoding: 'utf8' }));

  run('synth', 'bricks', '-o', 'map.exr', '--width', '64', '--height', '48');
  const timings = run('run', 'map.exr', '-o', 'whole', '--rays', '64', '--json');
  writeFileSync(join(folder, 'whole', 'run.json'), timings);
  mkdirSync(join(folder, 'whole', 'sweep'));
  for (const amplitude of ['0.01', '0.1', '1']) {
    run('bake', 'map.exr', '-o', 'step.exr', '--amplitude', amplitude, '--rays', '32', '--bounces', '2');
    run('curves', 'step.exr', '-o', join('whole', 'sweep', `${amplitude}.csv`));
  }
  writeFileSync(join(folder, 'whole', 'trade.json'), JSON.stringify(tradeStudy()));
  copyFileSync(join(pictures, 'bricks.png'), join(folder, 'whole', 'wall_seen.png'));
  writeFileSync(join(folder, 'whole', 'render.json'), JSON.stringify({ pictures: [{ name: 'wall_seen', files: ['wall_seen.png'] }] }));

  run('run', 'map.exr', '-o', 'no_bounces', '--rays', '32', '--bounces', '0');
  run('run', 'map.exr', '-o', 'one_bin', '--rays', '32', '--bins', '1');
  run('synth', 'flat', '-o', 'flat.exr', '--width', '8', '--height', '8');
  run('run', 'flat.exr', '-o', 'flat', '--rays', '16');
  for (const name of ['only_curves', 'only_bake', 'only_fit', 'only_check', 'no_fit', 'only_ao', 'only_light']) mkdirSync(join(folder, name));
  copyFileSync(join(folder, 'whole', 'curves.csv'), join(folder, 'only_curves', 'curves.csv'));
  copyFileSync(join(folder, 'whole', 'bake.exr'), join(folder, 'only_bake', 'bake.exr'));
  copyFileSync(join(folder, 'whole', 'fit.json'), join(folder, 'only_fit', 'fit.json'));
  copyFileSync(join(folder, 'whole', 'check.json'), join(folder, 'only_check', 'check.json'));
  for (const file of ['bake.exr', 'curves.csv', 'check.json']) copyFileSync(join(folder, 'whole', file), join(folder, 'no_fit', file));
  run('bake', 'map.exr', '-o', 'only_ao/bake.exr', '--outputs', 'ao', '--rays', '16');
  run('bake', 'map.exr', '-o', 'only_light/bake.exr', '--outputs', 'irradiance', '--rays', '16');

  const poor = {
    no_bounces: 'has no bounces',
    one_bin: 'one bin',
    flat: 'No fit.json',
    only_curves: 'No bake.exr',
    only_bake: 'No fit.json',
    only_fit: 'No curves',
    only_check: 'No bake.exr',
    no_fit: 'not fitted to this map',
    only_ao: 'has no irradiance',
    only_light: 'has no AO',
  };
  for (const name of Object.keys(poor)) report(name);
  return {
    poor,
    expected: report('whole', '--albedo', kAlbedo.join()),
    expectedOther: report('whole', '--albedo', kOtherAlbedo.join(), '-o', 'other.html'),
  };
}

function table(file) {
  const [head, ...rows] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return rows.map((row) => Object.fromEntries(row.map((cell, i) => [head[i], Number(cell)])));
}

// Returns the models without constants as tables: {ID: [{visibility, …, 'total_0.0', …}]}.
export function makeTables(hemibake, folder) {
  return Object.fromEntries(['visibility', 'visibility-ao', 'bounce-map'].map((model) => {
    const file = join(folder, `${model}.csv`);
    execFileSync(hemibake, ['export', 'none', '--model', model, '-o', file]);
    return [model, table(file)];
  }));
}

// Makes a page of each stored curve and its fits. Returns for each the bins that the library says, and its models as
// tables: {ID: [{ao, direct, bounce_ratio, 'total_0.0', …}]}.
export function makeCurvePages(hemibake, folder, stored) {
  const run = (...options) => execFileSync(hemibake, options, { cwd: folder, encoding: 'utf8' });
  return readdirSync(stored).filter((file) => file.endsWith('.csv')).map((file) => {
    const name = `curves_${basename(file, '.csv')}`;
    mkdirSync(join(folder, name));
    copyFileSync(join(stored, file), join(folder, name, 'curves.csv'));
    run('fit', join(name, 'curves.csv'), '-o', join(name, 'fit.json'));
    const models = Object.fromEntries(['bounded', 'published'].map((model) => {
      run('export', join(name, 'fit.json'), '--to', 'csv', '--model', model, '-o', join(name, 'model.csv'));
      return [model, table(join(folder, name, 'model.csv'))];
    }));
    return { name, models, bins: JSON.parse(run('report', name, '--json')).bins };
  });
}

// Makes a trade study as src/trade/trade_file.h describes it.
function tradeStudy() {
  const error = (rmse) => ({ rmse, bias: rmse / 3, max: 4 * rmse, p99: 3 * rmse });
  const runs = [64, 256].flatMap((rays) =>
    ['embree', 'slice'].map((method) => ({
      id: `${method}-${rays}`, method, settings: { rays }, representative: rays === 64, cpu_seconds: rays / 100,
      wall_seconds: rays / 200, repeats: 1, memory_bytes: 1 << 24, known: 1,
      error: { ao: error(1 / rays), direct: error(2 / rays) }, models: { bounded: { 'light.50': error(3 / rays) } },
    })));
  const front = (plane) => runs.slice(0, 2).map((run) => ({ id: run.id, model: '', cpu_seconds: run.cpu_seconds, rmse: run.error[plane].rmse }));
  return { effort: 'quick', planes: {}, runs, fronts: { ao: front('ao'), direct: front('direct'), 'light.50': [] } };
}
