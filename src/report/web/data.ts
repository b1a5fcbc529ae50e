// Reads the data that `hemibake report` put into the page (src/report/html_json.cpp).

export type Rgb = [number, number, number];

export interface Bin {
  low: number;
  high: number;
  count: number;
  mean?: number[]; // E_b/π at albedo 1; absent where count is 0
  spread?: number[]; // standard deviation over the bin's texels
  all_bounces?: number[]; // E/π at each of plot_albedos, with the tail after the last bounce; not in a sweep
  stored_bounces?: number; // Σ E_b/π at albedo 1
}

export interface Curves {
  bounces: number;
  has_counts: boolean;
  bins: Bin[];
}

export type Language = 'glsl' | 'hlsl' | 'cpp';

export interface Score {
  rms: number;
  max: number;
}

export type ModelId = 'visibility-ao' | 'visibility' | 'bounce-map' | 'bounded' | 'published' | 'notes';

export interface ModelData {
  id: ModelId;
  title: string;
  constants: Record<string, number>;
  shader: Record<Language, string>;
  score: Score | null; // over the bins of the curves; none of the bounce map
}

export interface PlaneList {
  width: number;
  height: number;
  stride: number;
  list: { name: string; step: number }[];
  ao_error: number;
  bounce_error: number;
  irradiance_error_over_pi: number;
  total_error_over_pi: number;
}

// Holds what a bounce map leaves of the light, E/π.
export interface BounceMapLoss {
  bounce_albedo: number;
  truth_rms: number; // how far the stored bounces tell the light at the map's own albedo
  albedos: number[];
  stored: { bits: number; box: number; rms: number[]; percentile: number[]; largest: number[] }[]; // at each of `albedos`
}

export interface Bake {
  width: number;
  height: number;
  mean_ao: number | null;
  mean_visibility: number | null;
  mean_irradiance: number[];
  mean_total: number | null;
  mean_residual: number | null;
  worst_residual: number | null;
  texel_errors: Record<string, number>[]; // at `albedo`: rms by the id of a model or of an other_models
  bounce_map: BounceMapLoss | null;
  planes: PlaneList;
  settings: Record<string, string | number | boolean> | null;
}

export interface Fit {
  model: string;
  formula: string;
  parameters: Record<string, { value: number; stderr: number | null }>;
  rms: number;
  max_error: number;
  points: number;
}

export interface Check {
  quantity: string;
  value: number | null;
  expected: number;
  tolerance: number | null; // null: for information
  passed: boolean;
  detail: string;
}

export interface Report {
  version: string;
  title: string;
  albedo: Rgb;
  plot_albedos: number[];
  bake: Bake | null;
  curves: Curves | null;
  fits: Record<string, Fit> | null;
  models: ModelData[];
  other_models: { id: string; title: string; score: Score | null }[];
  check: { passed: boolean; checks: Check[] } | null;
  run: Record<string, unknown> | null;
  trade: unknown;
  pictures: { name: string; here: boolean }[];
  sweep: { amplitude_m: number; curves: Curves }[];
}

export const report: Report = JSON.parse(document.getElementById('data')!.textContent!);

// Holds a bin with texels at its place on the AO axis.
export interface Point {
  ao: number;
  count: number;
  mean: number[];
  spread: number[];
  allBounces: number[];
  storedBounces: number;
}

export function pointsOf(curves: Curves): Point[] {
  return curves.bins
    .filter((bin) => bin.mean !== undefined)
    .map((bin) => ({
      ao: (bin.low + bin.high) / 2,
      count: bin.count,
      mean: bin.mean!,
      spread: bin.spread!,
      allBounces: bin.all_bounces ?? [],
      storedBounces: bin.stored_bounces ?? 0,
    }));
}
