/* A chart to keep: its picture, as pixels or as lines, or every value of it; `x` and `y` of a bar or a field are its names. */
function saveFile(url, name) {
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
}

function saveText(text, type, name) {
  const url = URL.createObjectURL(new Blob([text], {type}));
  saveFile(url, name);
  URL.revokeObjectURL(url);
}

function savePicture(chart) {
  saveFile(chart.getDataURL({pixelRatio: 2, backgroundColor: "#fff"}), "rovsim.png");
}

// Drawn once more as lines and letters: for a thesis, at any size. The page's charts are pixels.
async function saveVectors(chart) {
  const { echarts } = await import("nicegui-echart");
  const size = {width: chart.getWidth(), height: chart.getHeight()};
  const copy = echarts.init(null, null, {renderer: "svg", ssr: true, ...size});
  copy.setOption({...chart.getOption(), animation: false, backgroundColor: "#fff"});
  saveText(copy.renderToSVGString(), "image/svg+xml", "rovsim.svg");
  copy.dispose();
}

function saveValues(chart) {
  const shown = chart.getOption();
  const names = ["xAxis", "yAxis"].map((axis) => shown[axis]?.[0]?.data);
  const named = (data, k) => String(data?.[k]?.value ?? data?.[k] ?? k).replace("\u2212", "-");
  const quoted = (x) => /[",\n]/.test(x) ? '"' + String(x).replaceAll('"', '""') + '"' : x;
  const rows = shown.series.flatMap((series) => (series.data ?? []).map((point, k) => {
    const value = point?.value ?? point;
    const own = !Array.isArray(value) ? [named(names[0] ?? names[1], k), value]
      : value.length > 2 ? [named(names[0], value[0]), named(names[1], value[1]), value[2]] : value;
    const name = (series.id ?? series.name ?? "").replace(/\0.*/, "") || series.name;
    return [name, ...own].map((x) => quoted(x ?? "")).join(",");
  }));
  const head = rows[0]?.split(",").length > 3 ? "series,x,y,value" : "series,x,y";
  saveText([head, ...rows, ""].join("\n"), "text/csv", "rovsim.csv");
}

// ECharts takes every turn of the wheel: without Ctrl it belongs to the page.
addEventListener("wheel", event => {
  if (!event.ctrlKey && event.target.closest?.(".chart")) event.stopPropagation();
}, { capture: true });

// What the pointer is at: the time once, then each panel with its unit and its curves.
function tellPanels(points, titles) {
  const clean = text => text.replace(/[&<>"']/g, letter => `&#${letter.charCodeAt(0)};`);
  const known = points.filter(point => Number.isFinite(point.value?.[1])
    && !point.seriesId.endsWith(" of the band"));
  const lines = titles.map((title, k) => [title, known.filter(p => p.seriesId.startsWith(`${k}/`))])
    .filter(([, own]) => own.length)
    .map(([title, own]) => `<div>${clean(title)}: ` + own.map(point =>
      `${point.marker}${clean(point.seriesName)} <b>${Number(point.value[1]).toPrecision(3)}</b>`
    ).join(", ") + "</div>");
  return `${Number(points[0].axisValue).toFixed(2)} s${lines.join("")}`;
}
