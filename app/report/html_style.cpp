#include "app/report/html_sections.h"

#include <fmt/core.h>

namespace lodestone {

namespace {

constexpr std::string_view kDark = R"(
--bg:#14171b;--panel:#1b1f24;--raised:#252a31;--view:#1a1e23;--line:#2a2f36;--text:#e8eaed;
--quiet:#939ca9;--accent:#4cc2a0;--on-accent:#0c1512;--tint:rgb(76 194 160 / .12);--warning:#f0a35e;
--part-1:#5fa8d3;--part-2:#4cc2a0;--part-3:#c79bd8;--part-4:#d9b25f;--part-5:#7c8694;
)";

constexpr std::string_view kLight = R"(
--bg:#f5f6f8;--panel:#fff;--raised:#eceff2;--view:#1a1e23;--line:#dfe3e8;--text:#1a1e23;
--quiet:#5b6571;--accent:#0f7a5c;--on-accent:#fff;--tint:rgb(15 122 92 / .09);--warning:#a34d00;
--part-1:#3f86b5;--part-2:#2f9c7e;--part-3:#a170b6;--part-4:#b98d2f;--part-5:#8b95a2;
)";

constexpr std::string_view kLayout = R"css(
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%;text-size-adjust:100%}
body{margin:0;background:var(--bg);color:var(--text);line-height:1.45;font-size:14px;
font-family:Inter,system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans","DejaVu Sans",sans-serif;
font-variant-numeric:tabular-nums;-webkit-font-smoothing:antialiased}
main,.top,footer{max-width:1280px;margin:0 auto;padding:0 24px}
main{padding-bottom:24px}
.top{display:flex;justify-content:space-between;align-items:flex-start;gap:16px;padding-top:28px}
.brand{margin:0 0 4px;color:var(--accent);font-weight:600}
.brand span{color:var(--quiet);font-weight:400}
h1{margin:0;font-size:30px;line-height:1.2;font-weight:650;letter-spacing:-.015em;overflow-wrap:anywhere}
.target{margin:4px 0 0;color:var(--quiet);font-size:15px}
.target strong{color:var(--text);font-weight:600}
h2{margin:44px 0 12px;font-size:11px;line-height:1.3;font-weight:600;letter-spacing:.09em;
text-transform:uppercase;color:var(--quiet)}
h2+p{margin:-4px 0 12px}
h3{margin:0;font-size:14px;font-weight:600}
.quiet,small{color:var(--quiet)}
small{font-size:12px;font-weight:400}
.warning{color:var(--warning)}
.good{color:var(--accent);font-weight:700}
a{color:inherit}
:focus-visible{outline:2px solid var(--accent);outline-offset:2px}
.button,.segments button{font:inherit;color:var(--text);background:var(--raised);border:0;
border-radius:4px;padding:6px 12px;cursor:pointer}
.button:hover,.segments button:hover{color:var(--accent)}

.facts{display:flex;flex-wrap:wrap;gap:12px 32px;margin:20px 0 0;padding:14px 0;
border-top:1px solid var(--line);border-bottom:1px solid var(--line)}
.facts dt{color:var(--quiet);font-size:12px}
.facts dd{margin:0;font-size:16px;font-weight:600}
.highlights{display:grid;grid-template-columns:repeat(auto-fit,minmax(190px,1fr));gap:12px;
list-style:none;margin:16px 0 0;padding:0}
.highlights li{background:var(--panel);border-radius:6px;padding:12px 16px 14px}
.highlights p{margin:0;color:var(--quiet);font-size:12px}
.highlights .figure{margin:2px 0 6px;color:var(--text);font-size:22px;font-weight:600;letter-spacing:-.01em}
.highlights .swatch{margin-right:14px}

.swatch{display:inline-flex;align-items:center;gap:8px;font-weight:600;white-space:nowrap}
.swatch::before{content:"";flex:none;width:9px;height:9px;border-radius:50%;background:var(--lane)}

.stage{display:grid;grid-template-columns:minmax(0,1fr) 200px;background:var(--panel);border-radius:6px;
overflow:hidden}
.stage[hidden]{display:none}
.view{position:relative;aspect-ratio:4/3;max-height:78vh;width:100%;overflow:hidden;background:var(--view);
cursor:grab;touch-action:pan-y;user-select:none;-webkit-user-select:none}
.view.zoomed{touch-action:none}
.view:active{cursor:grabbing}
.view img{position:absolute;inset:0;width:100%;height:100%;object-fit:contain;transform-origin:0 0;
pointer-events:none}
.over{position:absolute;inset:0;overflow:hidden;background:var(--view)}
.divider{position:absolute;top:0;bottom:0;width:44px;margin-left:-22px;cursor:ew-resize;touch-action:none}
.divider::before{content:"";position:absolute;left:21px;top:0;bottom:0;width:2px;background:#e8eaed}
.divider::after{content:"◂ ▸";position:absolute;left:4px;top:50%;width:36px;height:36px;margin-top:-18px;
border-radius:50%;background:#e8eaed;color:#14171b;font-size:12px;line-height:36px;text-align:center}
.flicker .divider{display:none}
.tag{position:absolute;top:10px;padding:3px 9px;border-radius:4px;background:rgb(20 23 27 / .78);
color:#e8eaed;font-size:12px;font-weight:600;pointer-events:none}
.tag.left{left:10px}
.tag.right{right:10px}
.controls{display:flex;flex-direction:column;gap:14px;padding:16px;overflow-y:auto;max-height:78vh}
.segments{display:flex;gap:1px;border-radius:4px;overflow:hidden;flex:none}
.segments button{flex:1;border-radius:0;padding:6px 8px}
.segments button[aria-pressed=true]{background:var(--accent);color:var(--on-accent);font-weight:600}
fieldset{border:0;margin:0;padding:0;min-width:0}
legend{padding:0 0 4px;font-weight:600}
fieldset label{display:flex;gap:8px;align-items:center;padding:3px 6px;margin:0 -6px;border-radius:4px;cursor:pointer}
fieldset label:hover{background:var(--raised)}
fieldset label:has(:checked){background:var(--tint)}
fieldset .swatch{font-weight:400}
input[type=radio]{margin:0;accent-color:var(--accent)}
.hint{margin:auto 0 0;font-size:12px}
kbd{font:inherit;font-size:11px;background:var(--raised);border-radius:3px;padding:1px 5px}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(280px,1fr));gap:16px;margin-top:16px}
.pictures figure{margin:0;background:var(--panel);border-radius:6px;overflow:hidden}
.pictures figcaption,.numbers{display:flex;justify-content:space-between;align-items:baseline;gap:8px;
padding:9px 14px;margin:0}
.pictures img{display:block;width:100%;height:auto;background:var(--view)}
.pictures a{display:block;cursor:zoom-in}
.missing{background:var(--panel);border-radius:6px;padding:16px}

.scroll{overflow-x:auto;background:var(--panel);border-radius:6px}
table{border-collapse:separate;border-spacing:0;width:100%;font-size:13px}
th,td{padding:8px 10px;text-align:right;white-space:nowrap;vertical-align:baseline}
th{font-weight:400}
tr>:first-child{text-align:left;padding-left:16px;position:sticky;left:0;background:var(--panel);z-index:1}
tr>:last-child{padding-right:16px}
thead th{color:var(--quiet);font-size:12px;border-bottom:1px solid var(--line);vertical-align:bottom}
tbody tr+tr>*{border-top:1px solid var(--line)}
tbody tr:hover>*{background-image:linear-gradient(var(--tint),var(--tint))}
th small{display:block;padding-left:17px}
td.best{color:var(--accent);font-weight:650}
td.failure{text-align:left;white-space:normal;color:var(--warning)}
.bar-cell{text-align:left;width:24%;min-width:140px}
.bar{display:flex;height:10px;border-radius:2px;overflow:hidden;background:var(--raised)}
.bar i{display:block;height:100%;flex:none}
thead i{display:inline-block;width:8px;height:8px;border-radius:2px;margin-right:6px}
.part-1{background:var(--part-1)}.part-2{background:var(--part-2)}.part-3{background:var(--part-3)}
.part-4{background:var(--part-4)}.part-5{background:var(--part-5)}

.legend{display:flex;flex-wrap:wrap;gap:4px 20px;list-style:none;margin:0 0 12px;padding:0}
.legend li{display:flex;align-items:center;gap:6px;padding:2px 0;cursor:default}
.key{width:14px;height:14px}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr));gap:16px}
.chart-card{margin:0;background:var(--panel);border-radius:6px;padding:14px 16px 8px}
.chart{display:block;width:100%;height:auto;margin-top:8px;font-size:12px}
.chart text{fill:var(--quiet)}
.grid{stroke:var(--line);fill:none}
.line{stroke:var(--lane);stroke-width:2;fill:none;stroke-linejoin:round}
.marker{fill:var(--panel);stroke:var(--lane);stroke-width:1.8;stroke-linejoin:round}
.legend .marker{fill:var(--lane)}
.halo{fill:none;stroke:var(--lane);stroke-width:1.5}
.halo+.marker{fill:var(--lane)}
.reference{stroke:var(--quiet);stroke-dasharray:5 4;fill:none}
.reference-label{paint-order:stroke;stroke:var(--panel);stroke-width:4px;stroke-linejoin:round}
.series{transition:opacity .12s}
.charts.focused .series:not(.focus),.legend.focused li:not(.focus){opacity:.18}

.notes{margin:0;display:grid;grid-template-columns:max-content 1fr;gap:8px 24px}
.notes dd{margin:0;min-width:0;overflow-wrap:anywhere}
.notes ul,.method,.algorithms{margin:0;padding:0;list-style:none}
.notes li+li{margin-top:4px}
.method{color:var(--quiet);max-width:80ch;margin-top:12px}
.method strong{color:var(--text);font-weight:600}
.method li+li,.algorithms li+li{margin-top:6px}
.algorithms{max-width:100ch}
footer{border-top:1px solid var(--line);margin-top:32px;padding:16px 0 0;color:var(--quiet);font-size:12px}

@media (max-width:760px){
main,.top{padding-left:16px;padding-right:16px}
h1{font-size:24px}
.facts{gap:10px 24px}
.highlights{grid-template-columns:1fr 1fr}
.highlights .figure{font-size:18px}
.stage{grid-template-columns:minmax(0,1fr)}
.controls{display:grid;grid-template-columns:1fr 1fr;max-height:none}
.controls .segments{align-self:start}
.controls .segments:first-child{grid-column:1/-1}
.hint{display:none}
.pictures{grid-template-columns:1fr 1fr;gap:10px}
.pictures figcaption,.numbers{flex-wrap:wrap;padding:8px 10px}
.pictures figcaption{flex-direction:column;gap:2px}
.pictures figcaption .quiet{min-height:1.5em}
.notes{grid-template-columns:1fr;gap:4px}
.notes dd{margin-bottom:10px}
.chart-card{padding:12px 8px 4px}
.chart{font-size:15px}
}
@media (prefers-reduced-motion:reduce){.series{transition:none}}
@media print{.stage,#theme{display:none}body{font-size:11px}.pictures{grid-template-columns:repeat(3,1fr)}}
)css";

} // namespace

std::string pageStyle() {
    return fmt::format(":root{{color-scheme:dark;{0}}}\n.lane{{--lane:var(--on-dark)}}\n"
                       "@media (prefers-color-scheme:light){{\n"
                       ":root:not([data-theme=dark]){{color-scheme:light;{1}}}\n"
                       ":root:not([data-theme=dark]) .lane{{--lane:var(--on-light)}}\n}}\n"
                       ":root[data-theme=light]{{color-scheme:light;{1}}}\n"
                       ":root[data-theme=light] .lane{{--lane:var(--on-light)}}\n{2}",
                       kDark,
                       kLight,
                       kLayout);
}

} // namespace lodestone
