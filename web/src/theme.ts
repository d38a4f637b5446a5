// Colours of the page, once: CSS reads them as variables, the picture and the plots as strings.
import type { StageColours } from "./water/stage.ts";

export interface Theme extends StageColours {
  water: string;
  text: string;
  faint: string;
  grid: string;
}

let known: { theme: string; colours: Theme } | null = null;

/** Of the theme that the page has now. */
export function colours(): Theme {
  const theme = document.documentElement.dataset["theme"] ?? "light";
  if (known?.theme !== theme) {
    const style = getComputedStyle(document.documentElement);
    const of = (name: string) => style.getPropertyValue(`--${name}`).trim();
    known = {
      theme,
      colours: {
        paper: of("paper"), water: of("water"), text: of("text"), faint: of("faint"), grid: of("grid"), wall: of("wall"), sheet: of("sheet"), gate: of("gate"), body: of("body"),
        open: of("open"), probe: of("probe"), accent: of("accent"), profile: of("profile"),
      },
    };
  }
  return known.colours;
}
