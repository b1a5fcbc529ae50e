// Reads the colours that page.css has for light and dark.

export interface Theme {
  ink: string;
  faint: string;
  line: string;
  card: string;
  accent: string;
  second: string;
  third: string;
  dark: boolean;
}

const scheme = matchMedia('(prefers-color-scheme: dark)');
const print = matchMedia('print');

export function theme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const color = (name: string) => style.getPropertyValue(`--${name}`).trim();
  return {
    ink: color('ink'),
    faint: color('faint'),
    line: color('line'),
    card: color('card'),
    accent: color('accent'),
    second: color('second'),
    third: color('third'),
    dark: scheme.matches && !print.matches,
  };
}

export function onThemeChange(listener: () => void): void {
  scheme.addEventListener('change', listener);
  print.addEventListener('change', listener);
}

type Stops = [number, number, number][];

const kRampLight: Stops = [[201, 68, 14], [190, 24, 93], [109, 40, 217], [37, 99, 235], [8, 145, 178]];
const kRampDark: Stops = [[255, 170, 90], [255, 112, 166], [190, 150, 255], [110, 170, 255], [90, 220, 235]];

// Returns a colour along a ramp from warm (0) to cold (1) that stands out from the page.
export function ramp(position: number): string {
  return mix(theme().dark ? kRampDark : kRampLight, position);
}

const kHeights: Stops = [[68, 32, 110], [60, 80, 170], [30, 130, 160], [60, 175, 120], [240, 205, 70]];

// Returns a colour along a ramp from dark (0) to bright (1), for heights.
export function heightColor(position: number, alpha = 1): string {
  return mix(kHeights, position, alpha);
}

function mix(stops: Stops, position: number, alpha = 1): string {
  const at = Math.min(Math.max(position, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  const rgb = stops[i].map((from, c) => Math.round(from + (stops[i + 1][c] - from) * (at - i)));
  return alpha === 1 ? `rgb(${rgb.join(',')})` : `rgba(${rgb.join(',')},${alpha})`;
}
