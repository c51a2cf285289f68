// The report works without this; it adds where one is in the contents, which it folds in a narrow window, and enlarged figures.
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

const narrow = matchMedia("(max-width: 75rem)");
const contents = document.querySelector("nav details");
const fold = () => { contents.open = !narrow.matches; };
narrow.addEventListener("change", fold);
contents.addEventListener("click", (event) => { if (event.target.closest("a")) fold(); });
fold();

// A figure fills the window until it is closed: by its button, by Escape, or by a click beside the caption.
const enlarged = document.getElementById("enlarged");
const [frame, caption] = [enlarged.querySelector(".picture"), enlarged.querySelector(".caption")];
let opener = null;
for (const button of document.querySelectorAll(".enlarge")) {
  button.addEventListener("click", () => {
    const figure = button.closest("figure");
    const picture = button.querySelector("img").cloneNode();
    // How large it may grow is up to the window, how small to what can be read.
    picture.style.setProperty("--width", picture.getAttribute("width"));
    picture.style.setProperty("--height", picture.getAttribute("height"));
    frame.replaceChildren(picture);
    caption.replaceChildren(...figure.querySelector("figcaption").cloneNode(true).childNodes);
    caption.querySelector("strong").hidden = false;
    enlarged.setAttribute("aria-label", figure.getAttribute("aria-label"));
    opener = button;
    enlarged.showModal();
    // Where another figure was left is not where this one begins.
    for (const scrolled of [enlarged, frame, caption]) scrolled.scrollTo({ left: 0, top: 0, behavior: "instant" });
  });
}
enlarged.addEventListener("click", (event) => {
  if (!event.target.closest("form, .caption")) enlarged.close();
});
enlarged.addEventListener("close", () => opener?.focus({ preventScroll: true }));
