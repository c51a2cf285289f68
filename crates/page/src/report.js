// The report works without this. It marks the current part in the contents, folds them in a narrow window, enlarges figures.
"use strict";

// Marks the part being read in the contents.
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
    // The style sheet computes the size: largest by the window, smallest by legibility.
    picture.style.setProperty("--width", picture.getAttribute("width"));
    picture.style.setProperty("--height", picture.getAttribute("height"));
    frame.replaceChildren(picture);
    caption.replaceChildren(...figure.querySelector("figcaption").cloneNode(true).childNodes);
    caption.querySelector("strong").hidden = false;
    enlarged.setAttribute("aria-label", figure.getAttribute("aria-label"));
    opener = button;
    enlarged.showModal();
    // Resets the scroll position of the previous figure.
    for (const scrolled of [enlarged, frame, caption]) scrolled.scrollTo({ left: 0, top: 0, behavior: "instant" });
  });
}
enlarged.addEventListener("click", (event) => {
  if (!event.target.closest("form, .caption")) enlarged.close();
});
enlarged.addEventListener("close", () => opener?.focus({ preventScroll: true }));
