// The page, from top to bottom. The picture comes last: it waits for the bake's planes, which stand at the file's end.

import { showChecks, showSettings } from './checks';
import { showCurves } from './curves';
import { showModels } from './models';
import { showShader } from './shader';
import { showSummary, showTitle } from './summary';
import { showSurface } from './surface';
import { showSweep } from './sweep';
import { showTrade } from './trade';
import { showViewer } from './viewer';

showTitle();
showSummary();
showCurves();
showSurface();
showModels();
showSweep();
showTrade();
showShader();
showChecks();
showSettings();
document.documentElement.dataset.plots = 'ready';
document.addEventListener('DOMContentLoaded', () => void showViewer());
