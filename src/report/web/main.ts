// Fills the page. The picture comes last: it is the most work.

import { charts } from './chart';
import { showChecks, showSettings } from './checks';
import { showCurves } from './curves';
import { models } from './model';
import { showModels } from './models';
import { showPictures } from './pictures';
import { showShader } from './shader';
import { showSummary, showTitle } from './summary';
import { showSurface } from './surface';
import { showSweep } from './sweep';
import { showTrade } from './trade';
import { showViewer } from './viewer';

// For a console, and for the test that holds the page against the library.
Object.assign(window, { hemibake: { charts, models } });

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
