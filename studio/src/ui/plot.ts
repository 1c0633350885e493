/** Residuals of iterations, on a logarithmic axis. */
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { Method } from '../engine/types';

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
  const axis = { stroke: ink, grid: { stroke: `color-mix(in srgb, ${ink} 14%, transparent)` }, ticks: { show: false } };
  place.replaceChildren();
  new uPlot(
    {
      width: Math.max(240, place.clientWidth),
      height: 220,
      legend: { live: false },
      scales: { x: { time: false }, y: { distr: 3 } },
      axes: [{ ...axis, label: 'iterations', labelSize: 20 }, { ...axis, size: 54, values: (_plot, values) => values.map((value) => (Math.log10(value) % 2 === 0 ? value.toExponential(0) : '')) }],
      series: [{}, ...shown.map((method, i) => ({ label: method.name, stroke: COLORS[i % COLORS.length] ?? ink, width: 2, spanGaps: true, points: { show: method.residuals.length < 4 } }))],
    },
    [places, ...rows],
    place,
  );
}
