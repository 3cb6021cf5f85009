(* What holds of reals, whatever is rounded. *)
Require Import Reals Lra Psatz.
Open Scope R_scope.

Lemma square_is_positive : forall x, 0 <= x * x.
Proof. exact Rle_0_sqr. Qed.

(* The root of 1 + t, as count.rs bounds it. *)
Lemma root_of_one_and : forall t, -(1/4) <= t <= 1/4 -> 1 + t/2 - t*t/2 <= sqrt (1 + t) <= 1 + t/2.
Proof.
  intros t H. split.
  - apply Rsqr_incr_0_var; [|apply sqrt_pos]. rewrite Rsqr_sqrt by lra. unfold Rsqr.
    assert (0 <= t * t) by nra. assert (t * t * (t * t / 4 - t / 2 - 3 / 4) <= 0) by nra. nra.
  - apply Rsqr_incr_0_var; [|lra]. rewrite Rsqr_sqrt by lra. unfold Rsqr. nra.
Qed.

(* A sum of squares whose terms are off by factors within [a, b] is off by one. *)
Lemma of_a_sum : forall a b c1 c2 c3 s1 s2 s3, 0 <= s1 -> 0 <= s2 -> 0 <= s3 ->
  a <= c1 <= b -> a <= c2 <= b -> a <= c3 <= b ->
  a * (s1 + s2 + s3) <= c1 * s1 + c2 * s2 + c3 * s3 <= b * (s1 + s2 + s3).
Proof. intros. split; nra. Qed.

(* A number whose square is at most that of another. *)
Lemma by_squares : forall x y, 0 <= y -> x * x <= y * y -> x <= y.
Proof. intros x y Hy H. apply Rnot_lt_le. intro. nra. Qed.

(* Cauchy and Schwarz, in three dimensions. *)
Lemma cauchy : forall a b c x y z, (a*x + b*y + c*z) * (a*x + b*y + c*z) <= (a*a + b*b + c*c) * (x*x + y*y + z*z).
Proof.
  intros. pose proof (square_is_positive (a*y - b*x)). pose proof (square_is_positive (a*z - c*x)).
  pose proof (square_is_positive (b*z - c*y)). lra.
Qed.

(* The permanent of the magnitudes of two columns, a component: its square is at most twice that of the products. Summed over
   three components and with Cauchy and Schwarz the permanent of three columns is at most root 2 of the product of their lengths. *)
Lemma permanent : forall b1 b2 b3 c1 c2 c3,
  (Rabs (b2*c3) + Rabs (b3*c2)) * (Rabs (b2*c3) + Rabs (b3*c2)) + (Rabs (b3*c1) + Rabs (b1*c3)) * (Rabs (b3*c1) + Rabs (b1*c3))
  + (Rabs (b1*c2) + Rabs (b2*c1)) * (Rabs (b1*c2) + Rabs (b2*c1)) <= 2 * ((b1*b1 + b2*b2 + b3*b3) * (c1*c1 + c2*c2 + c3*c3)).
Proof.
  intros.
  assert (H : forall p q, (Rabs p + Rabs q) * (Rabs p + Rabs q) <= 2 * (p * p + q * q)).
  { intros p q. assert (Rabs p * Rabs p = p * p) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, square_is_positive).
    assert (Rabs q * Rabs q = q * q) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, square_is_positive).
    pose proof (square_is_positive (Rabs p - Rabs q)). lra. }
  pose proof (H (b2*c3) (b3*c2)). pose proof (H (b3*c1) (b1*c3)). pose proof (H (b1*c2) (b2*c1)).
  pose proof (square_is_positive (b1*c1)). pose proof (square_is_positive (b2*c2)). pose proof (square_is_positive (b3*c3)). lra.
Qed.

(* RIGID_TOGETHER: lane i has the diagonal's entry s_i and p_i beside it, s_i^2 + p_i^2 <= m^2: the form of a unit vector is at most
   root 5 of m. Each lane by Cauchy and Schwarz, m |x_i| root (x_i^2 + 4 x_{i+1}^2), which is h_i here. *)
Lemma lane : forall m s p x y h, 0 <= m -> s*s + p*p <= m*m -> 0 <= h -> h*h = x*x + 4*(y*y) ->
  s*(x*x) + 2*p*(x*y) <= m * (Rabs x * h).
Proof.
  intros m s p x y h Hm Hsp Hh H. apply by_squares.
  - apply Rmult_le_pos; [assumption|]. apply Rmult_le_pos; [apply Rabs_pos|assumption].
  - assert (E : Rabs x * Rabs x = x * x) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, square_is_positive).
    replace (m * (Rabs x * h) * (m * (Rabs x * h))) with (m * m * (Rabs x * Rabs x * (h * h))) by ring. rewrite E, H.
    replace ((s*(x*x) + 2*p*(x*y)) * (s*(x*x) + 2*p*(x*y))) with (x*x * ((s*x + p*(2*y)) * (s*x + p*(2*y)))) by ring.
    assert (C : (s*x + p*(2*y)) * (s*x + p*(2*y)) <= (s*s + p*p) * (x*x + 4*(y*y)))
      by (pose proof (square_is_positive (s*(2*y) - p*x)); lra).
    pose proof (square_is_positive x). pose proof (square_is_positive y).
    assert (D : (s*s + p*p) * (x*x + 4*(y*y)) <= m*m * (x*x + 4*(y*y))) by (apply Rmult_le_compat_r; lra).
    replace (m*m * (x*x * (x*x + 4*(y*y)))) with (x*x * (m*m * (x*x + 4*(y*y)))) by ring.
    apply Rmult_le_compat_l; lra.
Qed.

Lemma form_of_lanes : forall m s1 s2 s3 p1 p2 p3 x y z h1 h2 h3, 0 <= m ->
  s1*s1 + p1*p1 <= m*m -> s2*s2 + p2*p2 <= m*m -> s3*s3 + p3*p3 <= m*m -> x*x + y*y + z*z = 1 ->
  0 <= h1 -> h1*h1 = x*x + 4*(y*y) -> 0 <= h2 -> h2*h2 = y*y + 4*(z*z) -> 0 <= h3 -> h3*h3 = z*z + 4*(x*x) ->
  s1*(x*x) + 2*p1*(x*y) + (s2*(y*y) + 2*p2*(y*z)) + (s3*(z*z) + 2*p3*(z*x)) <= sqrt 5 * m.
Proof.
  intros m s1 s2 s3 p1 p2 p3 x y z h1 h2 h3 Hm A1 A2 A3 N H1 E1 H2 E2 H3 E3.
  pose proof (lane m s1 p1 x y h1 Hm A1 H1 E1). pose proof (lane m s2 p2 y z h2 Hm A2 H2 E2).
  pose proof (lane m s3 p3 z x h3 Hm A3 H3 E3).
  assert (S : Rabs x * h1 + Rabs y * h2 + Rabs z * h3 <= sqrt 5).
  { apply by_squares; [apply sqrt_pos|]. rewrite sqrt_sqrt by lra.
    pose proof (cauchy (Rabs x) (Rabs y) (Rabs z) h1 h2 h3) as C.
    assert (F : forall t, Rabs t * Rabs t = t * t) by (intro t; rewrite <- Rabs_mult; apply Rabs_pos_eq, square_is_positive).
    rewrite !F in C. rewrite E1, E2, E3, N in C. lra. }
  assert (m * (Rabs x * h1 + Rabs y * h2 + Rabs z * h3) <= m * sqrt 5) by (apply Rmult_le_compat_l; assumption). lra.
Qed.

(* ON_ARC: for unit vectors n, l, r with n.(l + r) >= 1 + l.r the sum of the chords |n - l| + |n - r| is at most root 8. *)
Lemma chords : forall a b nl nr lr, a*a = 2 - 2*nl -> b*b = 2 - 2*nr -> -1 <= lr -> 1 + lr <= nl + nr -> a + b <= sqrt 8.
Proof.
  intros a b nl nr lr A B L H. apply by_squares; [apply sqrt_pos|]. rewrite sqrt_sqrt by lra.
  pose proof (square_is_positive (a - b)). lra.
Qed.
