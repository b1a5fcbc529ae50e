// Shows the checks, and how the data were made.

import { report } from './data';
import { h, number, place, say, table } from './dom';

export function showChecks(): void {
  if (!report.check) return say('checks', 'The folder has no check.json: ‘hemibake check bake.exr --json’ prints one.');
  const rows = report.check.checks.map((check) => [
    check.quantity,
    check.tolerance === null ? 'shown' : check.passed ? h('span', { class: 'ok' }, '✓ ok') : h('span', { class: 'failed' }, '✗ failed'),
    number(check.value, 6),
    number(check.expected, 4),
    check.tolerance === null ? '–' : number(check.tolerance, 2),
    check.detail,
  ]);
  place('checks').append(table(['quantity', 'result', 'value', 'expected', 'tolerance', 'detail'], rows, 'Light is neither made nor lost'));
}

export function showSettings(): void {
  const settings = report.bake?.settings;
  if (!settings) return say('settings', 'There is no bake.exr, which says how it was made.');
  const rows = Object.entries(settings).map(([name, value]) => [name, String(value)]);
  place('settings').append(table(['setting', 'value'], rows, 'Attributes of bake.exr', 9));
}
