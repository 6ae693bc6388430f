/* A chart to keep: its picture, as pixels or as lines, or every value of it. */
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

/* NiceGUI (3.18) makes the chart a moment after its element, and ends in an error where a page that changed has taken
   the element away by then. */
function leftUndrawn(element) {
  const its = element.component.proxy;
  its.chart ??= {dispose() { its.chart = undefined; }};
}

/* `columns` names what stands in the table: its `x` and each of its `curves` by id, side by side over one x; or `names` of
   what each point tells, one below the other. */
function saveValues(chart, columns) {
  const shown = chart.getOption();
  const rows = columns.curves ? sideBySide(shown.series, columns) : oneBelowTheOther(shown, columns.names ?? []);
  const quoted = (x) => /[",\n]/.test(x) ? '"' + String(x).replaceAll('"', '""') + '"' : x ?? "";
  saveText([...rows.map((row) => row.map(quoted).join(",")), ""].join("\n"), "text/csv", "rovsim.csv");
}

function sideBySide(series, columns) {
  const curves = series.filter((one) => one.id in columns.curves);
  const rows = curves[0].data.map((point, k) => [point[0], ...curves.map((one) => one.data[k]?.[1])]);
  return [[columns.x, ...curves.map((one) => columns.curves[one.id])], ...rows];
}

function oneBelowTheOther(shown, names) {
  const axes = ["xAxis", "yAxis"].map((axis) => shown[axis]?.[0]);
  const named = (axis, k) => String(axis?.data?.[k]?.value ?? axis?.data?.[k] ?? k).replace("\u2212", "-");
  const rows = shown.series.flatMap((series) => (series.data ?? []).map((point, k) => {
    const value = point?.value ?? point;
    const own = !Array.isArray(value) ? [named(axes[0].data ? axes[0] : axes[1], k), value]
      : value.length > 2 ? [named(axes[0], value[0]), named(axes[1], value[1]), value[2]] : value;
    return [(series.name ?? "").replace(/\0.*/, ""), ...own];
  }));
  const heads = ["x", "y", "to"].map((other, k) => names[k] ?? (axes[k]?.name || other));
  const wide = Math.max(...rows.map((row) => row.length));
  return [["series", ...heads].slice(0, wide), ...rows];
}

// Numbers as everywhere else on the page: three digits are told, and a minus is a minus.
function tellNumber(value) {
  const told = [value].flat().map((one) => Number(one).toPrecision(3));
  return told.join(", ").replaceAll("-", "\u2212");
}

// The same for the ends of an axis, whose numbers are round.
function tellTick(value) {
  return value.toLocaleString("en", {maximumSignificantDigits: 12}).replace("-", "\u2212");
}

// Charts and the tank take every turn of the wheel: without Ctrl it belongs to the page.
addEventListener("wheel", event => {
  if (!event.ctrlKey && event.target.closest?.(".chart, .path")) event.stopPropagation();
}, { capture: true });

// What the pointer is at: the time once, then each panel with its unit and its curves.
function tellPanels(points, titles) {
  const clean = text => text.replace(/[&<>"']/g, letter => `&#${letter.charCodeAt(0)};`);
  const known = points.filter(point => Number.isFinite(point.value?.[1])
    && !point.seriesId.endsWith(" of the band"));
  const lines = titles.map((title, k) => [title, known.filter(p => p.seriesId.startsWith(`${k}/`))])
    .filter(([, own]) => own.length)
    .map(([title, own]) => `<div>${clean(title)}: ` + own.map(point =>
      `${point.marker}${clean(point.seriesName)} <b>${tellNumber(point.value[1])}</b>`
    ).join(", ") + "</div>");
  return `${Number(points[0].axisValue).toFixed(2)} s${lines.join("")}`;
}
