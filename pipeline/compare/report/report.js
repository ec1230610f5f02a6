"use strict";
(() => {
    const all = (selector, within = document) => [...within.querySelectorAll(selector)];

    // Pictures: one sample rate and one kind at a time.
    const chosen = {};
    function choose(group, value) {
        chosen[group] = value;
        for (const button of all(`button[data-${group}]`))
            button.setAttribute("aria-pressed", String(button.dataset[group] === value));
        if (group === "rate")
            for (const figure of all("figure[data-rate]")) figure.hidden = figure.dataset.rate !== value;
        else
            for (const part of all("[data-kind]:not(button)"))
                part.hidden = part.dataset.kind !== value && part.dataset.kind !== "always";
    }
    for (const group of ["rate", "kind"]) {
        const buttons = all(`button[data-${group}]`);
        for (const button of buttons) button.addEventListener("click", () => choose(group, button.dataset[group]));
        const first = group === "rate" ? buttons[buttons.length - 1] : buttons[0];
        if (first) choose(group, first.dataset[group]);
    }

    // A picture enlarged.
    const dialog = document.querySelector("dialog");
    for (const image of all(".pictures img, .crops img"))
        image.addEventListener("click", () => {
            dialog.querySelector("img").src = image.src;
            dialog.querySelector("p").textContent = image.alt;
            dialog.showModal();
        });
    dialog.addEventListener("click", () => dialog.close());

    // The table, sorted by the column whose heading was clicked; again: the other way.
    const body = document.querySelector("tbody");
    const key = (row, column) => {
        const cell = row.children[column];
        return cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
    };
    all("thead th").forEach((heading, column) => {
        heading.querySelector("button").addEventListener("click", () => {
            const direction = heading.getAttribute("aria-sort") === "ascending" ? -1 : 1;
            for (const other of all("thead th")) other.removeAttribute("aria-sort");
            heading.setAttribute("aria-sort", direction === 1 ? "ascending" : "descending");
            const rows = all("tr", body);
            rows.sort((a, b) => {
                const x = key(a, column), y = key(b, column);
                return direction * (typeof x === "number" ? x - y : x.localeCompare(y));
            });
            body.append(...rows);
        });
    });
})();
