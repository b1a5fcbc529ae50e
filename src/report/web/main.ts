// The page. The picture comes last: it is the most work.

import { showChecks, showSettings } from './checks';
import { showCurves } from './curves';
import { showModels } from './models';
import { showPictures } from './pictures';
import { showShader } from './shader';
import { showSummary, showTitle } from './summary';
import { showSurface } from './surface';
import { showSweep } from './sweep';
import { showTrade } from './trade';
import { showViewer } from './viewer';

showTitle();
showSummary();
document.addEventListener('DOMContentLoaded', () => {
  // What is there is painted before the rest is made.
  requestAnimationFrame(() =>
    setTimeout(() => {
      for (const show of [showCurves, showSurface, showModels, showSweep, showTrade, showShader, showPictures, showChecks, showSettings]) show();
      document.documentElement.dataset.plots = 'ready';
      void showViewer();
    }),
  );
});
