// Light and dark: as the system is set, until the reader chooses.

import { element } from "./dom.js";

/** A button that changes between light and dark; `changed` draws what style sheets do not reach. */
export function themeButton(changed) {
    const system = matchMedia("(prefers-color-scheme: dark)");
    const root = document.documentElement;
    const dark = () => (root.dataset.theme ?? (system.matches ? "dark" : "light")) === "dark";
    const button = element("button", { type: "button", class: "theme" });
    const say = () => {
        button.textContent = dark() ? "Light" : "Dark";
        button.setAttribute("aria-label", dark() ? "Change to light colours" : "Change to dark colours");
        changed();
    };
    button.addEventListener("click", () => {
        root.dataset.theme = dark() ? "light" : "dark";
        say();
    });
    system.addEventListener("change", say);
    say();
    return button;
}
