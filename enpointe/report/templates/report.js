// Selecting a frame of the stave shows the film at that key pose. The page reads well without this.
(function () {
  var score = document.querySelector(".score[data-times]");
  var video = document.querySelector("video");
  if (!score || !video) { return; }
  var times = score.dataset.times.split(" ").map(Number);
  score.querySelectorAll(".frame").forEach(function (frame) {
    var time = times[Number(frame.id.replace("frame-", ""))];
    function show() { video.pause(); video.currentTime = time; video.scrollIntoView({ block: "nearest" }); }
    frame.setAttribute("tabindex", "0");
    frame.setAttribute("role", "button");
    frame.addEventListener("click", show);
    frame.addEventListener("keydown", function (event) { if (event.key === "Enter") { show(); } });
  });
})();
