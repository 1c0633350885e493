/** Errors step by step, on a logarithmic axis. */
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { FitRound, Method } from '../engine/types';
import { power } from './text';

const MARGIN = 14;
const COLORS = ['#1971c2', '#e8590c', '#2f9e44', '#9c36b5'];

export function plotMethods(place: HTMLElement, methods: readonly Method[]): void {
  const shown = methods.filter((method) => method.failure === '' && method.residuals.length > 1);
  const places = [...new Set(shown.flatMap((method) => [...method.measuredAfter]))].sort((a, b) => a - b);
  const rows = shown.map((method) => {
    const at = new Map([...method.measuredAfter].map((iteration, i) => [iteration, method.residuals[i] ?? 0]));
    return places.map((iteration) => {
      const residual = at.get(iteration);
      return residual !== undefined && residual > 0 ? residual : null;
    });
  });
  const series = shown.map((method) => ({ label: method.name, few: method.residuals.length < 4 }));
  plotErrors(place, 'iterations', places, rows, series);
}

/** How far points are from the surface, round by round of a fit. */
export function plotRounds(place: HTMLElement, rounds: readonly FitRound[]): void {
  const positive = (number: number): number | null => (number > 0 ? number : null);
  const rows = [rounds.map((round) => positive(round.max)), rounds.map((round) => positive(round.rms))];
  const series = [{ label: 'max', few: rounds.length < 4 }, { label: 'rms', few: rounds.length < 4 }];
  plotErrors(place, 'rounds', rounds.map((_, i) => i + 1), rows, series);
}

function plotErrors(place: HTMLElement, steps: string, places: number[], rows: (number | null)[][], series: readonly { label: string; few: boolean }[]): void {
  const ink = getComputedStyle(place).color;
  const axis = { stroke: ink, grid: { stroke: `color-mix(in srgb, ${ink} 14%, transparent)`, width: 1 }, ticks: { show: false } };
  place.replaceChildren();
  const width = Math.max(240, place.parentElement?.clientWidth ?? 0) - 2 * MARGIN;
  new uPlot(
    {
      width,
      height: 230,
      legend: { live: false },
      cursor: { show: false },
      scales: { x: { time: false }, y: { distr: 3 } },
      axes: [
        { ...axis, label: steps, labelSize: 18, size: 28 },
        { ...axis, size: 48, splits: (_plot, _axis, low, high) => powers(low, high), filter: (_plot, splits) => splits, values: (_plot, values) => values.map((value) => power(value)) },
      ],
      series: [{}, ...series.map(({ label, few }, i) => ({ label, stroke: COLORS[i % COLORS.length] ?? ink, width: 2, spanGaps: true, points: { show: few } }))],
    },
    [places, ...rows],
    place,
  );
}

/** Powers of ten between two numbers: the even ones, of few all. */
function powers(low: number, high: number): number[] {
  const step = high / low > 1e4 ? 2 : 1;
  const first = step * Math.ceil(Math.log10(low) / step);
  const last = step * Math.floor(Math.log10(high) / step);
  return Array.from({ length: Math.max(0, (last - first) / step + 1) }, (_, i) => 10 ** (first + step * i));
}
