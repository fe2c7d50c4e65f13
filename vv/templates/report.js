(() => {
  // "−6.3×10⁻⁵" as a number; what is none comes last.
  const powers = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹";
  const power = (_, signs) => "e" + [...signs].map((s) => powers.indexOf(s)).map((i) => (i ? i - 1 : "-")).join("");
  const number = (text) => {
    const plain = text.replace(/−/g, "-").replace(/×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/, power);
    const found = plain.match(/-?\d+(\.\d+)?(e-?\d+)?/);
    return found ? Number(found[0]) : Infinity;
  };
  for (const table of document.querySelectorAll("main table")) {
    const body = table.tBodies[0];
    const rows = [...body.rows];
    if (rows.length < 3) continue;
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      // No button element: those are left out where a head is repeated on paper.
      const button = document.createElement("span");
      button.setAttribute("role", "button");
      button.tabIndex = 0;
      button.title = "sort by this column";
      button.append(...head.childNodes);
      head.append(button);
      const numbers = head.classList.contains("right");
      const text = (row) => row.cells[column].textContent.trim();
      const order = (a, b) =>
        numbers ? number(text(a)) - number(text(b)) || 0 : text(a).localeCompare(text(b), "en", { numeric: true });
      const sort = () => {
        const next = { none: "ascending", ascending: "descending", descending: "none" };
        const turn = next[head.getAttribute("aria-sort") || "none"];
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        if (turn !== "none") head.setAttribute("aria-sort", turn);
        const sign = turn === "descending" ? -1 : 1;
        const none = (row) => Number(numbers && number(text(row)) === Infinity);
        const sorted =
          turn === "none" ? rows : [...rows].sort((a, b) => none(a) - none(b) || sign * order(a, b));
        body.append(...sorted);
      };
      button.addEventListener("click", sort);
      button.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        sort();
      });
    });
  }
})();
