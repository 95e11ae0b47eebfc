// SPDX-License-Identifier: MIT
// Sorts a table by the column whose header is chosen; rows without a value stand last, and equal rows keep their order.
"use strict";
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = head.firstElementChild;
    button.addEventListener("click", () => {
      const isNumber = "number" in button.dataset;
      const ascending = head.getAttribute("aria-sort") === (isNumber && column > 0 ? "descending" : "none") ||
        (isNumber && column === 0 && head.getAttribute("aria-sort") !== "ascending");
      const value = (row) => {
        const cell = row.cells[column];
        if (!isNumber) return cell.textContent;
        return cell.dataset.value === "" ? NaN : Number(cell.dataset.value);
      };
      const rows = [...table.tBodies[0].rows].map((row) => [value(row), row]);
      rows.sort(([a], [b]) => {
        if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
        const order = isNumber ? a - b : a.localeCompare(b);
        return ascending ? order : -order;
      });
      table.tBodies[0].append(...rows.map(([, row]) => row));
      for (const other of heads) other.setAttribute("aria-sort", "none");
      head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
    });
  });
}
