/** Residuals of iterations, on a logarithmic axis. */
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { Method } from '../engine/types';
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
        { ...axis, label: 'iterations', labelSize: 18, size: 28 },
        { ...axis, size: 48, splits: (_plot, _axis, low, high) => powers(low, high), values: (_plot, values) => values.map((value) => power(value)) },
      ],
      series: [{}, ...shown.map((method, i) => ({ label: method.name, stroke: COLORS[i % COLORS.length] ?? ink, width: 2, spanGaps: true, points: { show: method.residuals.length < 4 } }))],
    },
    [places, ...rows],
    place,
  );
}

/** Even powers of ten between two numbers. */
function powers(low: number, high: number): number[] {
  const first = 2 * Math.ceil(Math.log10(low) / 2);
  const last = 2 * Math.floor(Math.log10(high) / 2);
  return Array.from({ length: Math.max(0, (last - first) / 2 + 1) }, (_, i) => 10 ** (first + 2 * i));
}
