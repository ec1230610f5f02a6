/* RISpec 3.2, A.5.1: a colour behind the picture. Files name it background or bgcolor; a bgcolor that is set
   counts. bgalpha is how much of it alpha shows. */
imager background(
    color background = 1, bgcolor = color (-1, -1, -1);
    float bgalpha = 1;)
{
    color behind = (comp(bgcolor, 0) >= 0) ? bgcolor : background;

    Ci += (1 - alpha) * behind;
    alpha += (1 - alpha) * bgalpha;
    Oi = alpha;
}
