// The report works without this; it adds where one is in the contents, enlarged figures, and whole prints.
"use strict";

// Marks the part that is being read in the contents.
const links = new Map([...document.querySelectorAll("nav a")].map((a) => [a.hash.slice(1), a]));
const parts = [...links.keys()].map((id) => document.getElementById(id));
function mark() {
  const line = innerHeight / 3;
  const ended = innerHeight + scrollY >= document.documentElement.scrollHeight - 2;
  const read = ended ? parts.at(-1) : parts.filter((part) => part.getBoundingClientRect().top < line).at(-1) ?? parts[0];
  for (const [id, link] of links) {
    if (id === read.id) link.setAttribute("aria-current", "true");
    else link.removeAttribute("aria-current");
  }
}
addEventListener("scroll", mark, { passive: true });
addEventListener("resize", mark);
mark();

// A figure fills the window until it is clicked or Escape is pressed.
const enlarged = document.getElementById("enlarged");
for (const button of document.querySelectorAll(".enlarge")) {
  button.addEventListener("click", () => {
    enlarged.replaceChildren(button.firstElementChild.cloneNode());
    enlarged.showModal();
  });
}
enlarged.addEventListener("click", () => enlarged.close());

// Paper cannot be unfolded.
let folded = [];
addEventListener("beforeprint", () => {
  folded = [...document.querySelectorAll("details:not([open])")];
  for (const details of folded) details.open = true;
});
addEventListener("afterprint", () => {
  for (const details of folded) details.open = false;
});
