// Light and dark: as the system is set, until the reader chooses.

import { element } from "./dom.js";

/** A button that changes between light and dark; `changed` draws what style sheets do not reach. */
export function themeButton(changed) {
    const system = matchMedia("(prefers-color-scheme: dark)");
    const root = document.documentElement;
    const button = element("button", { type: "button", class: "theme" });
    let chosen = false;
    const take = (theme) => {
        root.dataset.theme = theme;
        button.textContent = theme === "dark" ? "Light" : "Dark";
        button.setAttribute("aria-label", `Change to ${button.textContent.toLowerCase()} colours`);
        changed();
    };
    const follow = () => {
        if (!chosen) take(system.matches ? "dark" : "light");
    };
    button.addEventListener("click", () => {
        chosen = true;
        take(root.dataset.theme === "dark" ? "light" : "dark");
    });
    system.addEventListener("change", follow);
    follow();
    return button;
}
