// Makes page.html of this folder: index.html with the style and the bundled script inside. Places for the data stay
// as they are; src/report/html_page.cpp fills them.
import { build } from 'esbuild';
import { readFile, writeFile } from 'node:fs/promises';

const result = await build({
  entryPoints: ['main.ts', 'page.css'],
  bundle: true,
  minify: true,
  write: false,
  outdir: '.',
  format: 'iife',
  target: ['chrome109', 'firefox115', 'safari16.4'],
  legalComments: 'inline',
  logLevel: 'warning',
});
const text = (suffix) => result.outputFiles.find((file) => file.path.endsWith(suffix)).text;
const page = await readFile('index.html', 'utf8');
// Replaced by functions: the script has $ in it.
await writeFile(
  'page.html',
  page
    .replace('<!-- style -->', () => `<style>${text('.css')}</style>`)
    .replace('<!-- script -->', () => `<script>${text('.js')}</script>`),
);
