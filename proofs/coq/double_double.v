(* Double-double arithmetic: what its operations are off by. words.v has them as the code computes them, numbers are binary64 with
   subnormals. A word of magnitude M: |hi| <= M and |lo| <= u M. *)
From Flocq Require Import Core Relative Plus_error Pff2Flocq.
Require Import Reals Lra Psatz ZArith.
Require Import model constants words.
Open Scope R_scope.

Local Instance precision_is_positive : Prec_gt_0 53 := eq_refl.

Definition format x := generic_format radix2 (FLT_exp (-1074) 53) x.

Lemma format_rnd : forall x, format (rnd x).
Proof. intro x. unfold format, rnd. apply generic_format_round; [apply FLT_exp_valid; easy | apply valid_rnd_N]. Qed.

Lemma rnd_opp : forall x, rnd (- x) = - rnd x.
Proof. intro x. unfold rnd. apply round_NE_opp. Qed.

Lemma even_is_symmetric : forall x : Z, negb (Z.even x) = negb (negb (Z.even (- (x + 1)))).
Proof. intro x. rewrite Z.even_opp, Z.even_add. destruct (Z.even x); reflexivity. Qed.

Lemma format_opp : forall x, format x -> format (- x).
Proof. intros. apply generic_format_opp. assumption. Qed.

(* Sums lose at most u of themselves, whatever underflows. *)
Lemma of_sum : forall x y X, format x -> format y -> -X <= x + y <= X -> -(u * X) <= rnd (x + y) - (x + y) <= u * X.
Proof.
  intros x y X Fx Fy H.
  destruct (FLT_plus_error_N_ex radix2 (-1074) 53 (fun x => negb (Z.even x)) x y Fx Fy) as [e [E R]].
  unfold rnd. rewrite R.
  assert (B : Rabs e <= u).
  { apply Rle_trans with (1 := E). unfold u_ro. simpl. unfold u. lra. }
  apply Rabs_le_inv in B.
  assert (C : Rabs (e * (x + y)) <= u * X).
  { rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; apply Rabs_le; [exact B | exact H]. }
  apply Rabs_le_inv in C. lra.
Qed.

Lemma of_difference : forall x y X, format x -> format y -> -X <= x - y <= X -> -(u * X) <= rnd (x - y) - (x - y) <= u * X.
Proof. intros x y X Fx Fy H. apply (of_sum x (- y) X Fx (format_opp y Fy) H). Qed.

(* Products do so unless they underflow. *)
Definition in_range x := x = 0 \/ bpow radix2 (-1022) <= Rabs x.

Lemma of_product : forall x X, in_range x -> -X <= x <= X -> -(u * X) <= rnd x - x <= u * X.
Proof.
  intros x X [Z|G] H.
  - subst x. unfold rnd. rewrite round_0 by apply valid_rnd_N. unfold u. lra.
  - destruct (a_rounding_is_a_factor x G) as [e [E R]]. rewrite R.
    assert (B : Rabs e <= u).
    { apply Rle_trans with (1 := E). simpl. unfold u. lra. }
    assert (C : Rabs (e * x) <= u * X).
    { rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; [exact B | apply Rabs_le; exact H]. }
    apply Rabs_le_inv in C. lra.
Qed.

Definition fast_hi hi lo := rnd (hi + lo).
Definition fast_lo hi lo := rnd (lo - rnd (rnd (hi + lo) - hi)).

(* `renormalise` is exact where |hi| >= |lo|, and off by little more than u of lo else. *)
Lemma fast_is_exact : forall hi lo, format hi -> format lo -> Rabs lo <= Rabs hi -> fast_hi hi lo + fast_lo hi lo = hi + lo.
Proof.
  intros hi lo Fh Fl H. unfold fast_hi, fast_lo.
  replace (lo - rnd (rnd (hi + lo) - hi)) with (lo + rnd (hi - rnd (hi + lo))).
  - apply (Fast2Sum_correct (-1074) 53 (fun x => negb (Z.even x))); auto using even_is_symmetric; easy.
  - replace (hi - rnd (hi + lo)) with (- (rnd (hi + lo) - hi)) by ring. rewrite rnd_opp. ring.
Qed.

Lemma fast_anyway : forall hi lo L, format hi -> format lo -> 0 <= L -> -L <= hi <= L -> -L <= lo <= L ->
  -((u + 9*u*u) * L) <= fast_hi hi lo + fast_lo hi lo - (hi + lo) <= (u + 9*u*u) * L /\ -(4 * u * L) <= fast_lo hi lo <= 4 * u * L.
Proof.
  intros hi lo L Fh Fl HL Hh Hl. unfold fast_hi, fast_lo.
  pose proof (of_sum hi lo (2 * L) Fh Fl ltac:(lra)) as A.
  set (s := rnd (hi + lo)) in *. assert (Fs : format s) by apply format_rnd.
  pose proof (of_difference s hi ((1 + 2*u) * L) Fs Fh ltac:(unfold u in *; lra)) as B.
  set (z := rnd (s - hi)) in *. assert (Fz : format z) by apply format_rnd.
  pose proof (of_difference lo z ((3*u + 2*u*u) * L) Fl Fz ltac:(unfold u in *; lra)) as C.
  set (t := rnd (lo - z)) in *.
  unfold u in *. lra.
Qed.

Lemma two_sum_is_exact : forall a b, format a -> format b -> forall al bl, two_sum_hi a al b bl + two_sum_lo a al b bl = a + b.
Proof.
  intros a b Fa Fb al bl.
  apply (TwoSum_correct (-1074) 53 (fun x => negb (Z.even x))); auto using even_is_symmetric; easy.
Qed.

(* 2 to the power of emin + 2 prec - 1. *)
Lemma two_product_is_exact : forall a b, format a -> format b -> a * b = 0 \/ bpow radix2 (-969) <= Rabs (a * b) ->
  forall al bl, two_product_hi a al b bl + two_product_lo a al b bl = a * b.
Proof.
  intros a b Fa Fb H al bl.
  assert (H' : b * a = 0 \/ bpow radix2 (-1074 + 2 * 53 - 1) <= Rabs (b * a)) by (rewrite (Rmult_comm b a); exact H).
  destruct (Dekker radix2 (-1074) 53 (fun x => negb (Z.even x)) ltac:(easy) ltac:(easy) b a Fb Fa (or_introl eq_refl)) as [D _].
  specialize (D H').
  replace (bpow radix2 (53 - Z.div2 53) + 1) with 134217729 in D by (simpl; lra).
  fold format in D.
  change (round radix2 (FLT_exp (-1074) 53) (Znearest (fun x => negb (Z.even x)))) with rnd in D.
  rewrite (Rmult_comm a b) at 1. rewrite D.
  assert (S : forall x y, rnd (x - y) = - rnd (y - x)) by (intros; rewrite <- rnd_opp; f_equal; ring).
  assert (Split : forall x, rnd (rnd (x - rnd (x * 134217729)) + rnd (x * 134217729))
                          = rnd (rnd (134217729 * x) - rnd (rnd (134217729 * x) - x))).
  { intro x. rewrite (Rmult_comm x). rewrite (S (rnd (134217729 * x)) x). f_equal. ring. }
  rewrite !Split. unfold two_product_hi, two_product_lo. cbv zeta.
  rewrite (Rmult_comm a b).
  set (ah := rnd (rnd (134217729 * a) - rnd (rnd (134217729 * a) - a))).
  set (bh := rnd (rnd (134217729 * b) - rnd (rnd (134217729 * b) - b))).
  set (al' := rnd (a - ah)). set (bl' := rnd (b - bh)).
  rewrite (Rmult_comm ah bh), (Rmult_comm al' bl'), (Rmult_comm al' bh), (Rmult_comm ah bl').
  f_equal.
  set (r := rnd (b * a)).
  assert (P : forall x y, rnd (- x + y) = - rnd (x - y)) by (intros; rewrite <- rnd_opp; f_equal; ring).
  rewrite !P. rewrite <- rnd_opp. f_equal. ring.
Qed.

Definition magnitude hi lo M := - M <= hi <= M /\ -(u * M) <= lo <= u * M.

Lemma by_cases : forall x y, Rabs x <= Rabs y \/ (-Rabs x <= y <= Rabs x).
Proof. intros. destruct (Rle_dec (Rabs x) (Rabs y)); [left; assumption|right; apply Rabs_le_inv; lra]. Qed.

Lemma rnd_is_bounded : forall x y X, format x -> format y -> -X <= x + y <= X -> -((1 + u) * X) <= rnd (x + y) <= (1 + u) * X.
Proof. intros x y X Fx Fy H. pose proof (of_sum x y X Fx Fy H). lra. Qed.

Lemma abs_cases : forall x, 0 <= Rabs x /\ -Rabs x <= x <= Rabs x /\ (Rabs x = x \/ Rabs x = - x).
Proof. intro x. unfold Rabs. destruct (Rcase_abs x); lra. Qed.

Lemma before_rounding : forall x y B, format x -> format y -> -B <= rnd (x + y) <= B -> -((1 + 2*u) * B) <= x + y <= (1 + 2*u) * B.
Proof.
  intros x y B Fx Fy H. destruct (abs_cases (x + y)) as [P [Z C]].
  pose proof (of_sum x y (Rabs (x + y)) Fx Fy Z). set (k := Rabs (x + y)) in *. clearbody k. unfold u in *. lra.
Qed.

(* What is summed: th + tl the low words exactly, sl what the high words' sum leaves. *)
Lemma words_of_sum : forall sh sl th tl M, format sh -> format sl -> format th -> format tl -> 0 <= M ->
  sh = rnd (sh + sl) -> -M <= sh + sl <= M -> -(u * M) <= th + tl <= u * M -> th = rnd (th + tl) ->
  let c := rnd (sl + th) in let vh := fast_hi sh c in let vl := fast_lo sh c in let w := rnd (vl + tl) in
  -((wide_sum * (u*u) + 60*u*u*u) * M) <= fast_hi vh w + fast_lo vh w - (sh + sl + th + tl) <= (wide_sum * (u*u) + 60*u*u*u) * M
  /\ magnitude (fast_hi vh w) (fast_lo vh w) ((1 + 30*u) * M).
Proof.
  intros sh sl th tl M Fsh Fsl Fth Ftl HM Es Hs Ht Et c vh vl w.
  pose proof (of_sum sh sl M Fsh Fsl Hs) as S. rewrite <- Es in S.
  pose proof (of_sum th tl (u * M) Fth Ftl Ht) as T. rewrite <- Et in T.
  assert (Fc : format c) by apply format_rnd.
  assert (Fvh : format vh) by apply format_rnd. assert (Fvl : format vl) by apply format_rnd.
  assert (Fw : format w) by apply format_rnd.
  pose proof (of_sum sl th ((2*u + 2*u*u) * M) Fsl Fth ltac:(unfold u in *; lra)) as C. fold c in C.
  (* After the first three words: what they are off by, and how large vl and vh are. *)
  assert (First : -((2*u*u + 20*u*u*u) * M) <= vh + vl - (sh + sl + th) <= (2*u*u + 20*u*u*u) * M
    /\ -((1 + 6*u) * M) <= vh <= (1 + 6*u) * M
    /\ -((u + 9*u*u) * M) <= vl <= (u + 9*u*u) * M
    /\ ((forall V, -V <= vh <= V -> 0 <= V -> -((u + 2*u*u) * V) <= vl <= (u + 2*u*u) * V) \/ -(6*u*u*M) <= vl <= 6*u*u*M)).
  { pose proof (rnd_is_bounded sh c ((1 + 4*u) * M) Fsh Fc ltac:(unfold u in *; lra)) as V. fold (fast_hi sh c) in V. fold vh in V.
    destruct (by_cases sh c) as [H|H].
    - (* |sh| <= |c| *)
      assert (A := Rabs_le_inv sh (Rabs c) H). destruct (abs_cases c) as [P [Hc K]]. set (k := Rabs c) in *. clearbody k.
      assert (Q : -((1 + 2*u) * k) <= sh + sl <= (1 + 2*u) * k) by
        (apply before_rounding; [assumption|assumption|rewrite <- Es; exact A]).
      pose proof (of_sum sh sl ((1 + 2*u) * k) Fsh Fsl Q) as Y. rewrite <- Es in Y.
      assert (Hsl : -((u + 3*u*u) * k) <= sl <= (u + 3*u*u) * k) by (unfold u in *; lra).
      pose proof (of_sum sl th ((u + 3*u*u) * k + (1 + u) * u * M) Fsl Fth ltac:(unfold u in *; lra)) as D. fold c in D.
      assert (Hk : k <= (u + 6*u*u) * M) by (unfold u in *; lra).
      destruct (fast_anyway sh c k Fsh Fc P A Hc) as [F G]. fold vh in F. fold vl in F, G.
      repeat split; try (unfold u in *; lra).
    - (* |c| <= |sh| *)
      assert (E : vh + vl = sh + c) by (apply fast_is_exact; [assumption|assumption|apply Rabs_le; exact H]).
      pose proof (of_sum sh c ((1 + 4*u) * M) Fsh Fc ltac:(unfold u in *; lra)) as W. fold (fast_hi sh c) in W. fold vh in W.
      repeat split; try (unfold u in *; lra). left. intros V0 HV HV0.
      assert (Q : -((1 + 2*u) * V0) <= sh + c <= (1 + 2*u) * V0) by (apply before_rounding; assumption).
      pose proof (of_sum sh c ((1 + 2*u) * V0) Fsh Fc Q) as Y. fold (fast_hi sh c) in Y. fold vh in Y.
      unfold u in *; lra. }
  destruct First as [F1 [F2 [F3 F4]]].
  pose proof (of_sum vl tl ((u + 12*u*u) * M) Fvl Ftl ltac:(unfold u in *; lra)) as W. fold w in W.
  destruct (by_cases vh w) as [H|H].
  - assert (A := Rabs_le_inv vh (Rabs w) H). destruct (abs_cases w) as [P [Hw K]]. set (k := Rabs w) in *. clearbody k.
    assert (Hk : k <= 9*u*u*M).
    { destruct F4 as [F4|F4].
      - specialize (F4 k A P).
        pose proof (of_sum vl tl ((u + 2*u*u) * k + (u + u*u) * u * M) Fvl Ftl ltac:(unfold u in *; lra)) as D. fold w in D.
        unfold u in *; lra.
      - pose proof (of_sum vl tl (8*u*u * M) Fvl Ftl ltac:(unfold u in *; lra)) as D. fold w in D.
        unfold u in *; lra. }
    destruct (fast_anyway vh w k Fvh Fw P A Hw) as [F G].
    unfold magnitude, wide_sum in *. unfold u in *; lra.
  - assert (E : fast_hi vh w + fast_lo vh w = vh + w) by (apply fast_is_exact; [assumption|assumption|apply Rabs_le; exact H]).
    pose proof (of_sum vh w ((1 + 8*u) * M) Fvh Fw ltac:(unfold u in *; lra)) as D. fold (fast_hi vh w) in D.
    unfold magnitude, wide_sum in *. unfold u in *; lra.
Qed.

(* What is multiplied: p + e the high words' product exactly, x and y those of a high and a low word, z of the low words; one
   factor's low word is at most a rounding of its high word. *)
Lemma words_of_product : forall p e x y z P M, format p -> format e -> 0 <= P <= M ->
  p = rnd (p + e) -> Rabs (p + e) = P -> in_range x -> in_range y ->
  -(u * M) <= x <= u * M -> -(u * M) <= y <= u * M -> -(u * u * M) <= z <= u * u * M ->
  -((u + 2*u*u) * P) <= x <= (u + 2*u*u) * P \/ -((u + 2*u*u) * P) <= y <= (u + 2*u*u) * P ->
  let l := rnd (e + rnd (rnd x + rnd y)) in
  -((wide_product * (u*u) + 200*u*u*u) * M) <= fast_hi p l + fast_lo p l - (p + e + x + y + z)
    <= (wide_product * (u*u) + 200*u*u*u) * M
  /\ magnitude (fast_hi p l) (fast_lo p l) ((1 + 30*u) * M).
Proof.
  intros p e x y z P M Fp Fe HP Ep HPa Rx Ry Hx Hy Hz Good l.
  assert (HPp : - P <= p + e <= P) by (apply Rabs_le_inv; lra).
  pose proof (of_sum p e P Fp Fe HPp) as A. rewrite <- Ep in A.
  pose proof (of_product x (u * M) Rx Hx) as Bx. pose proof (of_product y (u * M) Ry Hy) as By.
  assert (Fx : format (rnd x)) by apply format_rnd. assert (Fy : format (rnd y)) by apply format_rnd.
  set (x1 := rnd x) in *. set (y1 := rnd y) in *.
  pose proof (of_sum x1 y1 ((2*u + 2*u*u) * M) Fx Fy ltac:(unfold u in *; lra)) as C.
  assert (Fs : format (rnd (x1 + y1))) by apply format_rnd. set (s := rnd (x1 + y1)) in *.
  pose proof (of_sum e s ((3*u + 6*u*u) * M) Fe Fs ltac:(unfold u in *; lra)) as D. fold l in D.
  assert (Fl : format l) by apply format_rnd.
  destruct (by_cases p l) as [H|H].
  - assert (Hp := Rabs_le_inv p (Rabs l) H). destruct (abs_cases l) as [K [Hl K']]. set (k := Rabs l) in *. clearbody k.
    assert (Q : -((1 + 2*u) * k) <= p + e <= (1 + 2*u) * k) by
      (apply before_rounding; [assumption|assumption|rewrite <- Ep; exact Hp]).
    assert (HPk : P <= (1 + 2*u) * k) by (destruct (abs_cases (p + e)) as [_ [_ [C'|C']]]; rewrite <- HPa, C'; lra).
    assert (Small : k <= (u + 20*u*u) * M
      /\ -((3*u*u + 90*u*u*u) * M) <= l - (e + x + y) <= (3*u*u + 90*u*u*u) * M).
    { destruct Good as [G|G].
      - pose proof (of_product x ((u + 2*u*u) * P) Rx G) as Bx'. fold x1 in Bx'.
        pose proof (of_sum x1 y1 ((u + 9*u*u) * P + (u + u*u) * M) Fx Fy ltac:(unfold u in *; lra)) as C'. fold s in C'.
        pose proof (of_sum e s ((2*u + 20*u*u) * P + (u + 4*u*u) * M) Fe Fs ltac:(unfold u in *; lra)) as D'. fold l in D'.
        assert (k <= (u + 20*u*u) * M) by (unfold u in *; lra).
        unfold u in *; lra.
      - pose proof (of_product y ((u + 2*u*u) * P) Ry G) as By'. fold y1 in By'.
        pose proof (of_sum x1 y1 ((u + 9*u*u) * P + (u + u*u) * M) Fx Fy ltac:(unfold u in *; lra)) as C'. fold s in C'.
        pose proof (of_sum e s ((2*u + 20*u*u) * P + (u + 4*u*u) * M) Fe Fs ltac:(unfold u in *; lra)) as D'. fold l in D'.
        assert (k <= (u + 20*u*u) * M) by (unfold u in *; lra).
        unfold u in *; lra. }
    destruct (fast_anyway p l k Fp Fl K Hp Hl) as [F G].
    unfold magnitude, wide_product in *. unfold u in *; lra.
  - assert (E : fast_hi p l + fast_lo p l = p + l) by (apply fast_is_exact; [assumption|assumption|apply Rabs_le; exact H]).
    pose proof (of_sum p l ((1 + 8*u) * M) Fp Fl ltac:(unfold u in *; lra)) as W. fold (fast_hi p l) in W.
    unfold magnitude, wide_product in *. unfold u in *; lra.
Qed.

(* The code's sums. *)
Theorem sum_is_off_by_3u2 : forall ah al bh bl A B, format ah -> format al -> format bh -> format bl ->
  0 <= A -> 0 <= B -> magnitude ah al A -> magnitude bh bl B ->
  Rabs (sum_hi ah al bh bl + sum_lo ah al bh bl - (ah + al + (bh + bl))) <= (wide_sum * (u*u) + 60*u*u*u) * (A + B)
  /\ magnitude (sum_hi ah al bh bl) (sum_lo ah al bh bl) ((1 + 30*u) * (A + B)).
Proof.
  intros ah al bh bl A B Fah Fal Fbh Fbl HA HB Ma Mb. unfold magnitude in Ma, Mb.
  pose proof (two_sum_is_exact ah bh Fah Fbh 0 0) as H. pose proof (two_sum_is_exact al bl Fal Fbl 0 0) as L.
  set (sh := two_sum_hi ah 0 bh 0) in *. set (sl := two_sum_lo ah 0 bh 0) in *.
  set (th := two_sum_hi al 0 bl 0) in *. set (tl := two_sum_lo al 0 bl 0) in *.
  assert (Fsh : format sh) by apply format_rnd. assert (Fsl : format sl) by apply format_rnd.
  assert (Fth : format th) by apply format_rnd. assert (Ftl : format tl) by apply format_rnd.
  destruct (words_of_sum sh sl th tl (A + B) Fsh Fsl Fth Ftl) as [E M'].
  - lra.
  - rewrite H. reflexivity.
  - rewrite H. lra.
  - rewrite L. lra.
  - rewrite L. reflexivity.
  - split; [|exact M']. apply Rabs_le.
    replace (ah + al + (bh + bl)) with (sh + sl + th + tl) by lra. exact E.
Qed.

(* A difference is the sum with both words negated. *)
Theorem difference_is_a_sum : forall ah al bh bl,
  difference_hi ah al bh bl = sum_hi ah al (- bh) (- bl) /\ difference_lo ah al bh bl = sum_lo ah al (- bh) (- bl).
Proof. intros. split; reflexivity. Qed.

Definition does_not_underflow x y := x * y = 0 \/ bpow radix2 (-969) <= Rabs (x * y).

(* The code's products; one of the factors has a low word that is no more than its high word's rounding. *)
Theorem product_is_off_by_8u2 : forall ah al bh bl A B, format ah -> format al -> format bh -> format bl ->
  0 <= A -> 0 <= B -> magnitude ah al A -> magnitude bh bl B ->
  Rabs al <= (u + 2*u*u) * Rabs ah \/ Rabs bl <= (u + 2*u*u) * Rabs bh ->
  does_not_underflow ah bh -> in_range (ah * bl) -> in_range (al * bh) ->
  Rabs (product_hi ah al bh bl + product_lo ah al bh bl - (ah + al) * (bh + bl)) <= (wide_product * (u*u) + 200*u*u*u) * (A * B)
  /\ magnitude (product_hi ah al bh bl) (product_lo ah al bh bl) ((1 + 30*u) * (A * B)).
Proof.
  intros ah al bh bl A B Fah Fal Fbh Fbl HA HB [Mah Mal] [Mbh Mbl] Good Np Nx Ny.
  pose proof (two_product_is_exact ah bh Fah Fbh Np 0 0) as H.
  set (p := two_product_hi ah 0 bh 0) in *. set (e := two_product_lo ah 0 bh 0) in *.
  assert (Fp : format p) by apply format_rnd. assert (Fe : format e) by apply format_rnd.
  assert (Times : forall x y X Y, 0 <= X -> 0 <= Y -> Rabs x <= X -> Rabs y <= Y -> Rabs (x * y) <= X * Y)
    by (intros; rewrite Rabs_mult; apply Rmult_le_compat; try apply Rabs_pos; assumption).
  apply Rabs_le in Mah, Mal, Mbh, Mbl. assert (U : 0 <= u) by (unfold u; lra).
  assert (UA : 0 <= u * A) by (apply Rmult_le_pos; assumption). assert (UB : 0 <= u * B) by (apply Rmult_le_pos; assumption).
  pose proof (Times ah bh A B HA HB Mah Mbh) as Tp. pose proof (Times ah bl A (u * B) HA UB Mah Mbl) as Tx.
  pose proof (Times al bh (u * A) B UA HB Mal Mbh) as Ty. pose proof (Times al bl (u * A) (u * B) UA UB Mal Mbl) as Tz.
  destruct (words_of_product p e (ah * bl) (al * bh) (al * bl) (Rabs (ah * bh)) (A * B) Fp Fe) as [E M'].
  - split; [apply Rabs_pos|exact Tp].
  - rewrite H. reflexivity.
  - rewrite H. reflexivity.
  - exact Nx.
  - exact Ny.
  - apply Rabs_le_inv. lra.
  - apply Rabs_le_inv. lra.
  - apply Rabs_le_inv. lra.
  - destruct Good as [G|G].
    + right. apply Rabs_le_inv. rewrite !Rabs_mult.
      replace ((u + 2*u*u) * (Rabs ah * Rabs bh)) with ((u + 2*u*u) * Rabs ah * Rabs bh) by ring.
      apply Rmult_le_compat_r; [apply Rabs_pos|exact G].
    + left. apply Rabs_le_inv. rewrite !Rabs_mult.
      replace ((u + 2*u*u) * (Rabs ah * Rabs bh)) with (Rabs ah * ((u + 2*u*u) * Rabs bh)) by ring.
      apply Rmult_le_compat_l; [apply Rabs_pos|exact G].
  - split; [|exact M']. apply Rabs_le.
    replace ((ah + al) * (bh + bl)) with (p + e + ah * bl + al * bh + al * bl) by (rewrite H; ring). exact E.
Qed.
