// The error on the screen against time, of rows {file: 'lacerta' or 'draco', psnr, milliseconds}, as a picture: SVG that the browser turns into PNG, so that
// no plotting program is needed.
import {writeFileSync} from 'node:fs';

export async function drawCurves(page, rows, path) {
  const width = 640, height = 400, left = 60, bottom = 50, top = 30, right = 20;
  const end = 1.05 * Math.max(...rows.map(row => row.milliseconds)), low = Math.min(...rows.map(row => row.psnr)) - 5, high = Math.max(...rows.map(row => row.psnr)) + 3;
  const x = time => left + (width - left - right) * time / end, y = psnr => height - bottom - (height - bottom - top) * (psnr - low) / (high - low);
  const steps = file => {
    const points = rows.filter(row => row.file === file);
    return points.map((row, i) => `${i === 0 ? `M${x(row.milliseconds)},${height - bottom}` : ''}V${y(row.psnr)}H${x(points[i + 1]?.milliseconds ?? end)}`).join('');
  };
  const ticks = (from, to, count) => Array.from({length: count + 1}, (unused, i) => from + (to - from) * i / count);
  const text = (at, down, anchor, words) => `<text x="${at}" y="${down}" text-anchor="${anchor}">${words}</text>`;
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" style="background:#fff" font-family="sans-serif" font-size="12">
    ${ticks(0, end, 6).map(time => text(x(time), height - bottom + 16, 'middle', (time / 1000).toFixed(end < 3000 ? 2 : 1))).join('')}
    ${ticks(low, high, 6).map(psnr => text(left - 6, y(psnr) + 4, 'end', psnr.toFixed(0)) + `<path d="M${left},${y(psnr)}H${width - right}" stroke="#ddd"/>`).join('')}
    <path d="${steps('lacerta')}" fill="none" stroke="#0a7d33" stroke-width="2"/><path d="${steps('draco')}" fill="none" stroke="#b3261e" stroke-width="2"/>
    ${text((left + width) / 2, height - 12, 'middle', 'seconds after the request, over 100 kB/s')}${text(left, 18, 'start', 'dB on the screen: Lacerta green, Draco of the same final error red')}</svg>`;
  // Through a canvas: a screenshot would wait for the compositor, which software rendering keeps busy.
  const png = await page.evaluate(async ([text, w, h]) => {
    const image = new Image(), canvas = Object.assign(document.createElement('canvas'), {width: w, height: h});
    image.src = `data:image/svg+xml;utf8,${encodeURIComponent(text)}`;
    await image.decode();
    const context = canvas.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(0, 0, w, h);
    context.drawImage(image, 0, 0);
    return canvas.toDataURL('image/png').split(',')[1];
  }, [svg, width, height]);
  writeFileSync(path, Buffer.from(png, 'base64'));
}
