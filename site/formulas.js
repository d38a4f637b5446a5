// Draws what pymdownx.arithmatex has marked as formulas; the files of KaTeX lie beside the pages.
document.addEventListener("DOMContentLoaded", () => {
  renderMathInElement(document.body, {
    delimiters: [{ left: "\\(", right: "\\)", display: false }, { left: "\\[", right: "\\]", display: true }],
    throwOnError: false,
  });
});
