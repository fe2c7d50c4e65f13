#!/usr/bin/env node
// Looks at a report as its readers do: wide screen, laptop, phone, dark, paper. Writes pictures and a PDF, and says
// what is wrong: errors in the console, requests to a network, a page wider than its screen, tables that do not sort,
// links that lead nowhere.
//
//     npm install playwright-core          # in a folder outside of the project
//     node look_at_report.mjs reports/index.html OUT [BROWSER]
//
// BROWSER is a Chromium, /usr/bin/chromium without. Exit status: 0 fine, 1 something is wrong, 2 wrong use.

import { existsSync, mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [page_path, out, executablePath = "/usr/bin/chromium"] = process.argv.slice(2);
if (!page_path || !out || !existsSync(page_path)) {
  console.error("wanted: node look_at_report.mjs REPORT/index.html OUT [BROWSER]");
  process.exit(2);
}
let chromium;
try {
  ({ chromium } = createRequire(join(process.cwd(), "x.js"))("playwright-core"));
} catch {
  console.error("look_at_report.mjs needs playwright-core in the present folder: npm install playwright-core");
  process.exit(2);
}

// What a browser does of its own accord is no request of the page.
const QUIET = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];
const SCREENS = [
  { name: "wide", width: 1920, height: 1080 },
  { name: "laptop", width: 1280, height: 800 },
  { name: "phone", width: 400, height: 800 },
  { name: "dark", width: 1280, height: 800, colorScheme: "dark" },
];

const wrong = [];
const url = pathToFileURL(resolve(page_path)).href;
mkdirSync(out, { recursive: true });
const browser = await chromium.launch({ executablePath, args: QUIET });

async function open({ name, width, height, colorScheme = "light", javaScriptEnabled = true }) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme, javaScriptEnabled });
  const page = await context.newPage();
  page.on("console", (said) => said.type() === "error" && wrong.push(`${name}: console: ${said.text()}`));
  page.on("pageerror", (error) => wrong.push(`${name}: ${error.message}`));
  page.on("request", (request) => {
    if (!/^(file|data):/.test(request.url())) wrong.push(`${name}: asks for ${request.url()}`);
  });
  await page.goto(url);
  return page;
}

// Pictures of the top and of the beginning of every chapter.
async function photograph(page, name) {
  const ids = await page.$$eval("main > section", (all) => all.map((one) => one.querySelector("[id]").id));
  await page.screenshot({ path: join(out, `${name}-top.png`) });
  for (const id of ids) {
    await page.evaluate((at) => document.getElementById(at).scrollIntoView({ behavior: "instant" }), id);
    await page.waitForTimeout(150);
    await page.screenshot({ path: join(out, `${name}-${id}.png`) });
  }
}

async function links(page) {
  const targets = await page.$$eval("a[href]", (all) => [...new Set(all.map((a) => a.getAttribute("href")))]);
  for (const target of targets) {
    if (/^[a-z]+:/.test(target)) continue;
    const [file, anchor] = target.split("#");
    if (file && !existsSync(join(dirname(page_path), file))) wrong.push(`link: ${target} is not there`);
    if (!file && !(await page.$(`[id="${anchor}"]`))) wrong.push(`link: #${anchor} is not there`);
  }
  return targets.length;
}

// Sorts the first table that has numbers, up, down and back.
async function sorts(page) {
  const head = await page.$("main thead th.right [role=button]");
  if (!head) return wrong.push("no table sorts");
  const rows = () =>
    head.evaluate((button) => [...button.closest("table").tBodies[0].rows].map((row) => row.textContent).join("\n"));
  const states = [await rows()];
  for (let k = 0; k < 3; k += 1) {
    await head.click();
    states.push(await rows());
  }
  if (states[0] === states[1] && states[1] === states[2]) wrong.push("a table does not sort");
  if (states[0] !== states[3]) wrong.push("a table does not come back to its own order");
}

for (const screen of SCREENS) {
  const page = await open(screen);
  const { wide, screenWide } = await page.evaluate(() => ({
    wide: document.documentElement.scrollWidth,
    screenWide: document.documentElement.clientWidth,
  }));
  if (wide > screenWide) wrong.push(`${screen.name}: the page is ${wide} wide, the screen ${screenWide}`);
  await photograph(page, screen.name);
  if (screen.name === "laptop") {
    console.log(`${await links(page)} links`);
    await sorts(page);
    await page.pdf({ path: join(out, "report.pdf"), preferCSSPageSize: true });
    await page.emulateMedia({ media: "print" });
    await page.setViewportSize({ width: 673, height: 950 }); // A4 within its margins; turned, 1002.
    const cut = await page.$$eval("table, figure, pre", (all) =>
      all
        .filter((one) => {
          const room = one.closest(".turned") ? 1002 : 673;
          return one.getBoundingClientRect().width > room + 1;
        })
        .map((one) => one.closest("[id]")?.id),
    );
    cut.forEach((id) => wrong.push(`paper: ${id} is cut off`));
  }
  await page.context().close();
}
const plain = await open({ name: "without scripts", width: 1280, height: 800, javaScriptEnabled: false });
await plain.screenshot({ path: join(out, "without-scripts-top.png") });
await browser.close();

wrong.forEach((what) => console.error(what));
console.log(wrong.length ? `${wrong.length} wrong` : `fine; pictures in ${out}`);
process.exit(wrong.length ? 1 : 0);
